#include "libcore/coding/quantise_colors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libcore/base/index.h"
#include "libcore/coding/color_model.h"
#include "libcore/coding/later_bits.h"
#include "libcore/coding/normal_equations.h"
#include "libcore/coding/range_coder.h"

namespace imgmesh::coding {
namespace {

constexpr double kMostLevel = 32767;
// Sweeps of the fit before the first vertex is set.
constexpr int kSweeps = 100;

// What a vertex's channel should be, as an offset from its guess [grey levels].
struct Target {
    double offset, step;
    double stiffness;  // squared error over squared offset
    double bit_price;
};

// The cheapest of 0, the nearest level, one more and up to two less. later(level): bits of vertices to come.
template <class Later>
int best_level(const ColorModel& model, const ColorGuess& guess, const Target& target, Later&& later) {
    const int nearest =
        static_cast<int>(std::lround(std::clamp(target.offset / target.step, -kMostLevel, kMostLevel)));
    const int inward = nearest > 0 ? -1 : 1;
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](int level) {
        const double off = level * target.step - target.offset;
        double cost = target.stiffness * off * off;
        if (target.bit_price > 0) cost += target.bit_price * (model.bits(guess, level) + later(level));
        if (cost >= least) return;
        best = level;
        least = cost;
    };
    consider(0);
    consider(nearest - inward);
    for (int k = 0, level = nearest; k < 3 && level != 0; ++k, level += inward) consider(level);
    return best;
}

}  // namespace

QuantisedColors quantise_colors(const CodedShape& shape, const ColorPlan& plan,
                                std::span<const FaceMoments> moments, int channels,
                                const ColorChoice& choice) {
    const std::size_t count = shape.point.size(), depth = as_index(channels);
    NormalEquations fit(shape, moments, channels);
    fit.solve(kSweeps);
    LaterBits later(plan, depth, choice.steps[0] / double{kColorUnit});
    ColorModel model(plan, channels, choice.steps);
    QuantisedColors out;
    out.level.resize(count * depth);
    NoCoder coder;
    for (std::size_t v = 0; v < count; ++v) {
        const double stiffness = fit.stiffness(v);
        later.look_at(v, fit.values());
        for (std::size_t c = 0; c < depth; ++c) {
            const ColorGuess guess = model.guess(v, c);
            const double from = guess.value / double{kColorUnit}, step = guess.step / double{kColorUnit};
            const Target target{fit.value(v, c) - from, step, choice.weight[c] * stiffness, choice.bit_price};
            // Neighbours' predictions count four fifths of a surprise.
            const int level =
                best_level(model, guess, target, [&](int k) { return later(c, from + 0.8 * step * k); });
            out.bits += model.bits(guess, level);
            out.level[v * depth + c] = model.code(coder, v, guess, level);
            fit.set(v, c, model.values()[v * depth + c] / double{kColorUnit});
        }
        fit.settle_after(v);
    }
    out.value.assign(model.values().begin(), model.values().end());
    out.error = fit.error();
    return out;
}

}  // namespace imgmesh::coding
