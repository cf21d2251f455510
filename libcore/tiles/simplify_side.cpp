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

    // The ends keep the features of `line`: other sides begin there too.
    std::vector<float> solve(std::span<const float> line) && {
        const std::size_t count = vertices_.size(), last = count - 1;
        for (std::size_t c = 0; c < channels_; ++c) {
            const double first_f = line[c], last_f = line[line.size() - channels_ + c];
            right_[channels_ + c] -= next_[0] * first_f;
            right_[(last - 1) * channels_ + c] -= next_[last - 1] * last_f;
            right_[c] = first_f;
            right_[last * channels_ + c] = last_f;
        }
        own_[0] = own_[last] = 1;
        next_[0] = next_[last - 1] = 0;
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
    side.vertices = line_vertices(line, channels, params.threshold);
    side.features.assign(line.begin(), line.end());
    if (count < 2) return side;
    const std::vector<int> resting(count, 0);
    std::vector<int> shifts = resting;
    const auto fit = [&] {
        LineFit sums(side.vertices, channels);
        sums.add(line, shifts, 1 - params.gouraud_share);
        sums.add(line, resting, params.gouraud_share);
        side.features = std::move(sums).solve(line);
    };
    fit();
    if (params.smoothness > 0)
        for (int n = 0; n < kRounds; ++n) {
            shifts = line_shifts(line, channels, side.vertices, side.features, params.smoothness);
            fit();
        }
    if (params.smoothness > 0)
        for (const int shift : shifts) side.shifts.push_back(static_cast<float>(shift) / kShiftSteps);
    return side;
}

Side coarser_side(const Side& side, int channels) {
    Side coarse;
    for (const int v : half_of_vertices(side.vertices, side.features, channels)) {
        coarse.vertices.push_back(side.vertices[as_index(v)]);
        const float* feature = &side.features[as_index(v) * as_index(channels)];
        coarse.features.insert(coarse.features.end(), feature, feature + channels);
    }
    return coarse;
}

}  // namespace imgmesh
