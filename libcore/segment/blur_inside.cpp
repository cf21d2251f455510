#include "libcore/segment/blur_inside.h"

#include <algorithm>
#include <array>

#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

constexpr int kGrain = 16;  // rows a block
constexpr int kReach = 2;
constexpr std::array<float, 2 * kReach + 1> kWeights = {1, 4, 6, 4, 1};

// A weight and a colour times that weight. Sums of them are divided in the end.
constexpr std::size_t kSums = 4;

// Blurs a line that has kReach pixels more at both ends.
void blur_line(const std::vector<float>& padded, std::span<float> sums) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
        float sum = 0;
        for (std::size_t k = 0; k < kWeights.size(); ++k) sum += kWeights[k] * padded[i + k * kSums];
        sums[i] = sum;
    }
}

}  // namespace

FeatureImage blur_inside(const FeatureImage& image, const Cells& cells) {
    const std::size_t row_size = as_index(cells.width) * kSums;
    std::vector<float> rows(row_size * as_index(cells.height));
    const auto row_of = [&](int y) { return std::span(rows).subspan(as_index(y) * row_size, row_size); };
    parallel_blocks(0, cells.height, kGrain, [&](int begin, int end) {
        std::vector<float> padded(row_size + 2 * kReach * kSums);
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < cells.width; ++x) {
                float* const sums = padded.data() + as_index(x + kReach) * kSums;
                const bool inside = cells.at(x, y) != kNone;
                const float* const color = image.pixel(x, y);
                sums[0] = inside ? 1.0f : 0.0f;
                for (std::size_t c = 0; c < 3; ++c) sums[1 + c] = inside ? color[c] : 0.0f;
            }
            blur_line(padded, row_of(y));
        }
    });
    FeatureImage result(image.width, image.height, 3, std::vector<float>(image.sample_count()));
    parallel_blocks(0, cells.height, kGrain, [&](int begin, int end) {
        std::vector<float> sums(row_size);
        for (int y = begin; y < end; ++y) {
            std::fill(sums.begin(), sums.end(), 0.0f);
            for (int k = -kReach; k <= kReach; ++k) {
                if (y + k < 0 || y + k >= cells.height) continue;
                const float weight = kWeights[as_index(k + kReach)];
                const std::span<const float> row = row_of(y + k);
                for (std::size_t i = 0; i < row_size; ++i) sums[i] += weight * row[i];
            }
            for (int x = 0; x < cells.width; ++x) {
                if (cells.at(x, y) == kNone) continue;
                const float* const sum = sums.data() + as_index(x) * kSums;
                for (std::size_t c = 0; c < 3; ++c) result.pixel(x, y)[c] = sum[1 + c] / sum[0];
            }
        }
    });
    return result;
}

}  // namespace imgmesh
