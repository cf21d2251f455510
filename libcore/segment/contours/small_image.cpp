#include "libcore/segment/contours/small_image.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

constexpr int kGrain = 16;  // rows a block

// Gives pixels outside the mask the colour of the pixel inside from which they are reached in the fewest
// steps, so that filters see no edge along the mask.
void fill_outside(SmallImage& small) {
    const GridSize& size = small.inside;
    std::vector<std::size_t> front, next;
    std::vector<std::uint8_t> known = small.inside.values;
    for (std::size_t i = 0; i < known.size(); ++i)
        if (known[i]) front.push_back(i);
    while (!front.empty()) {
        next.clear();
        for (const std::size_t i : front) {
            const int x = size.x_of(i), y = size.y_of(i);
            for (const auto& [dx, dy] :
                 {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
                if (!size.contains(x + dx, y + dy)) continue;
                const std::size_t j = size.index(x + dx, y + dy);
                if (known[j]) continue;
                known[j] = 1;
                std::copy_n(small.luv.pixel(i), 3, small.luv.pixel(j));
                next.push_back(j);
            }
        }
        front.swap(next);
    }
}

}  // namespace

int measuring_factor(const GridSize& size) {
    return std::max(1,
                    static_cast<int>(std::lround(std::sqrt(double(size.pixel_count()) / kMeasuredPixels))));
}

int disc_factor(const GridSize& size) {
    const int thin = std::min(size.width, size.height);
    return std::min(measuring_factor(size), std::max(1, thin / 2));
}

SmallImageSums::SmallImageSums(const GridSize& image, int factor)
    : factor_(factor),
      pixels_(GridSize{(image.width + factor - 1) / factor, (image.height + factor - 1) / factor}) {}

void SmallImageSums::add(const FeatureImage& part, const Grid<Id>& regions, int left, int top) {
    const int bottom = top + part.height;
    parallel_blocks(top / factor_, (bottom - 1) / factor_ + 1, kGrain, [&](int begin, int end) {
        for (int y = std::max(top, begin * factor_); y < std::min(bottom, end * factor_); ++y)
            for (int x = 0; x < part.width; ++x) {
                if (regions.at(x, y - top) == kNone) continue;
                const float* luv = part.pixel(x, y - top);
                Pixel& pixel = pixels_.at((left + x) / factor_, y / factor_);
                for (std::size_t c = 0; c < 3; ++c) pixel.sum[c] += double(luv[c]);
                ++pixel.count;
            }
    });
}

SmallImage SmallImageSums::finish() const {
    SmallImage small;
    small.factor = factor_;
    small.inside = Grid<std::uint8_t>(pixels_);
    small.luv = FeatureImage(pixels_.width, pixels_.height, 3, std::vector<float>(pixels_.size() * 3));
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const Pixel& pixel = pixels_[i];
        if (pixel.count == 0) continue;
        small.inside[i] = 1;
        for (std::size_t c = 0; c < 3; ++c)
            small.luv.pixel(i)[c] = static_cast<float>(pixel.sum[c] / pixel.count);
    }
    fill_outside(small);
    return small;
}

SmallImage small_image(const FeatureImage& image, const Grid<Id>& regions, int factor) {
    SmallImageSums sums(image, factor);
    sums.add(image, regions, 0, 0);
    return sums.finish();
}

}  // namespace imgmesh
