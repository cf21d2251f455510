#include "libcore/tiles/line_shifts.h"

#include <array>
#include <cstdint>
#include <limits>

#include "libcore/base/index.h"

namespace imgmesh {
namespace {

constexpr int kStates = 2 * kMostShift + 1;
using Costs = std::array<float, kStates>;
using Choices = std::array<std::int8_t, kStates>;

int shift_of(int state) {
    return state - kMostShift;
}

}  // namespace

std::vector<int> line_shifts(std::span<const float> line, int channels, std::span<const int> vertices,
                             std::span<const float> colors, double smoothness) {
    constexpr float kNever = std::numeric_limits<float>::infinity();
    const int count = as_int(line.size()) / channels;
    std::vector<Choices> from(as_index(count));
    std::array<float, 2 * kStates> bend;  // cost of the difference of two shifts
    for (int d = -(kStates - 1); d < kStates; ++d) {
        const double step = static_cast<double>(d) / kShiftSteps;
        // Pixels stay in order.
        bend[as_index(d + kStates)] =
            d <= -kShiftSteps ? kNever : static_cast<float>(smoothness * step * step);
    }
    Costs costs;
    costs.fill(kNever);
    costs[kMostShift] = 0;
    std::size_t segment = 0;  // the first that reaches to the pixel's least place
    for (int i = 1; i < count; ++i) {
        Costs next;
        std::size_t s = segment;
        for (int state = 0; state < kStates; ++state) {
            const int place = i * kShiftSteps + shift_of(state);
            const bool possible = place > 0 && place < (count - 1) * kShiftSteps;
            if (i + 1 == count ? state != kMostShift : !possible) {
                next[as_index(state)] = kNever;
                continue;
            }
            while (s + 2 < vertices.size() && vertices[s + 1] * kShiftSteps < place) ++s;
            const int a = vertices[s], b = vertices[s + 1];
            const float t =
                static_cast<float>(place - a * kShiftSteps) / static_cast<float>((b - a) * kShiftSteps);
            float error = 0;
            for (int c = 0; c < channels; ++c) {
                const float ca = colors[s * as_index(channels) + as_index(c)],
                            cb = colors[(s + 1) * as_index(channels) + as_index(c)];
                const float d = ca + t * (cb - ca) - line[as_index(i * channels + c)];
                error += d * d;
            }
            float best = kNever;
            int choice = 0;
            for (int before = 0; before < kStates; ++before) {
                const float cost = costs[as_index(before)] + bend[as_index(state - before + kStates)];
                if (cost < best) {
                    best = cost;
                    choice = before;
                }
            }
            next[as_index(state)] = best + error;
            from[as_index(i)][as_index(state)] = static_cast<std::int8_t>(choice);
        }
        while (segment + 2 < vertices.size() &&
               vertices[segment + 1] * kShiftSteps < i * kShiftSteps - kMostShift)
            ++segment;
        costs = next;
    }
    std::vector<int> shifts(as_index(count), 0);
    int state = kMostShift;
    for (int i = count - 1; i > 0; --i) {
        shifts[as_index(i)] = shift_of(state);
        state = from[as_index(i)][as_index(state)];
    }
    return shifts;
}

}  // namespace imgmesh
