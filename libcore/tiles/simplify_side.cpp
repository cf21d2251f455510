#include "libcore/tiles/simplify_side.h"

#include <algorithm>

#include "libcore/base/index.h"
#include "libcore/tiles/line_segments.h"
#include "libcore/tiles/line_shifts.h"

namespace imgmesh {
namespace {

// Shifts and colours are fitted to each other so often.
constexpr int kRounds = 3;

// Features of the vertices of a line by least squares. The normal equations are tridiagonal.
class LineFit {
  public:
    LineFit(std::span<const int> vertices, int channels)
        : vertices_(vertices),
          channels_(as_index(channels)),
          own_(vertices.size()),
          next_(vertices.size()),
          right_(vertices.size() * channels_) {}

    // Adds the pixels of a line, each at its shift, in that order.
    void add(std::span<const float> line, std::span<const int> shifts, double weight) {
        const std::size_t count = line.size() / channels_;
        std::size_t s = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double place = static_cast<double>(i) + static_cast<double>(shifts[i]) / kShiftSteps;
            while (s + 2 < vertices_.size() && vertices_[s + 1] <= place) ++s;
            const double t = (place - vertices_[s]) / (vertices_[s + 1] - vertices_[s]);
            own_[s] += weight * (1 - t) * (1 - t);
            own_[s + 1] += weight * t * t;
            next_[s] += weight * t * (1 - t);
            for (std::size_t c = 0; c < channels_; ++c) {
                const double f = line[i * channels_ + c];
                right_[s * channels_ + c] += weight * (1 - t) * f;
                right_[(s + 1) * channels_ + c] += weight * t * f;
            }
        }
    }

    std::vector<float> solve() && {
        const std::size_t count = vertices_.size();
        for (std::size_t s = 0; s + 1 < count; ++s) {
            const double factor = next_[s] / own_[s];
            own_[s + 1] -= factor * next_[s];
            for (std::size_t c = 0; c < channels_; ++c)
                right_[(s + 1) * channels_ + c] -= factor * right_[s * channels_ + c];
        }
        std::vector<float> out(right_.size());
        for (std::size_t s = count; s-- > 0;)
            for (std::size_t c = 0; c < channels_; ++c) {
                double& r = right_[s * channels_ + c];
                if (s + 1 < count) r -= next_[s] * right_[(s + 1) * channels_ + c];
                r /= own_[s];
                out[s * channels_ + c] = static_cast<float>(r);
            }
        return out;
    }

  private:
    std::span<const int> vertices_;
    std::size_t channels_;
    std::vector<double> own_, next_, right_;
};

}  // namespace

Side simplify_side(std::span<const float> line, int channels, const SideParams& params) {
    Side side;
    const std::size_t count = line.size() / as_index(channels);
    const auto round = [&] {
        if (!params.round) return;
        for (std::size_t v = 0; v < side.vertices.size(); ++v)
            params.round(&side.features[v * as_index(channels)]);
    };
    side.vertices = line_vertices(line, channels, params.threshold);
    side.features.assign(line.begin(), line.end());
    if (count < 2) {
        round();
        return side;
    }
    const std::vector<int> resting(count, 0);
    std::vector<int> shifts = resting;
    const auto fit = [&] {
        LineFit sums(side.vertices, channels);
        sums.add(line, shifts, 1 - params.gouraud_share);
        sums.add(line, resting, params.gouraud_share);
        side.features = std::move(sums).solve();
    };
    fit();
    if (params.smoothness > 0)
        for (int n = 0; n < kRounds; ++n) {
            round();
            shifts = line_shifts(line, channels, side.vertices, side.features, params.smoothness);
            fit();
        }
    round();
    if (params.smoothness > 0)
        for (const int shift : shifts) side.shifts.push_back(static_cast<float>(shift) / kShiftSteps);
    return side;
}

Side coarser_side(std::span<const Side> parts, int channels) {
    Side whole;
    for (const Side& part : parts) {
        const int offset = whole.vertices.empty() ? 0 : whole.vertices.back();
        const std::size_t first = whole.vertices.empty() ? 0 : 1;  // shared
        for (std::size_t v = first; v < part.vertices.size(); ++v)
            whole.vertices.push_back(offset + part.vertices[v]);
        whole.features.insert(whole.features.end(),
                              part.features.begin() + static_cast<std::ptrdiff_t>(first * as_index(channels)),
                              part.features.end());
    }
    Side coarse;
    for (const int v : half_of_vertices(whole.vertices, whole.features, channels)) {
        coarse.vertices.push_back(whole.vertices[as_index(v)]);
        const float* feature = &whole.features[as_index(v) * as_index(channels)];
        coarse.features.insert(coarse.features.end(), feature, feature + channels);
    }
    return coarse;
}

}  // namespace imgmesh
