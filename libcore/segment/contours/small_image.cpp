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

SmallImage small_image(const FeatureImage& image, const Grid<Id>& regions, int factor) {
    const int width = (image.width + factor - 1) / factor, height = (image.height + factor - 1) / factor;
    SmallImage small;
    small.factor = factor;
    small.inside = Grid<std::uint8_t>(GridSize{width, height});
    small.luv = FeatureImage(width, height, 3, std::vector<float>(small.inside.size() * 3));
    parallel_blocks(0, height, kGrain, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < width; ++x) {
                std::array<double, 3> sum{};
                int count = 0;
                for (int fy = y * factor; fy < std::min((y + 1) * factor, image.height); ++fy)
                    for (int fx = x * factor; fx < std::min((x + 1) * factor, image.width); ++fx) {
                        if (regions.at(fx, fy) == kNone) continue;
                        const float* luv = image.pixel(fx, fy);
                        for (std::size_t c = 0; c < 3; ++c) sum[c] += double(luv[c]);
                        ++count;
                    }
                if (count == 0) continue;
                small.inside.at(x, y) = 1;
                for (std::size_t c = 0; c < 3; ++c)
                    small.luv.pixel(x, y)[c] = static_cast<float>(sum[c] / count);
            }
    });
    fill_outside(small);
    return small;
}

}  // namespace imgmesh
