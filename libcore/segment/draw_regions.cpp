#include "libcore/segment/draw_regions.h"

#include <algorithm>
#include <functional>

#include "libcore/base/parallel.h"
#include "libcore/image/luv_encoder.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 16;

// A strong yellow: rare in images, lighter than nearly all of them, and seen beside any other hue.
constexpr float kLine[3] = {93, 10, 98};

Image encode(const LabelImage& labels, const SourceInfo& source,
             const std::function<Vec3f(int x, int y)>& color) {
    const bool mask = std::find(labels.begin(), labels.end(), kNone) != labels.end();
    Image image = make_image(labels.width, labels.height, mask ? 4 : 3);
    image.color_space = source.color_space;
    image.sample_type = source.sample_type;
    const LuvEncoder encoder(source.color_space);
    parallel_blocks(0, labels.height, kGrainRows, [&](int first, int last) {
        const std::size_t width = as_index(labels.width);
        std::vector<float> planes(3 * width);
        for (int y = first; y < last; ++y) {
            for (int x = 0; x < labels.width; ++x) {
                const bool outside = labels.at(x, y) == kNone;
                const Vec3f luv = outside ? Vec3f(Vec3f::Zero()) : color(x, y);
                for (int c = 0; c < 3; ++c) planes[as_index(c) * width + as_index(x)] = luv[c];
                if (mask) image.pixel(x, y)[3] = outside ? 0.0f : 1.0f;
            }
            encoder.encode_row(planes, labels.width, image.pixel(0, y), image.channels);
        }
    });
    return image;
}

}  // namespace

Image draw_flat(const LabelImage& labels, const std::vector<Vec3f>& colors, const SourceInfo& source) {
    return encode(labels, source, [&](int x, int y) { return colors[labels.at(x, y)]; });
}

Image draw_outlines(const LabelImage& labels, const FeatureImage& image, const SourceInfo& source) {
    return encode(labels, source, [&](int x, int y) -> Vec3f {
        const Id region = labels.at(x, y);
        const bool line = labels.at(std::min(x + 1, labels.width - 1), y) != region ||
                          labels.at(x, std::min(y + 1, labels.height - 1)) != region;
        return line ? Vec3f(kLine[0], kLine[1], kLine[2]) : Vec3f(Eigen::Map<const Vec3f>(image.pixel(x, y)));
    });
}

}  // namespace imgmesh
