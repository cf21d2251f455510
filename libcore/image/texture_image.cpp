#include "libcore/image/texture_image.h"

#include <algorithm>
#include <cassert>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

// How far colours spread out of the mask [pixels]: drawn at an eighth of its size, a texture still mixes
// pixels inside with these alone.
constexpr int kSpread = 8;
constexpr int kGrainRows = 16;

std::array<int, 3> color_channels(const Image& image) {
    const int grey = image.channel("Y");
    const std::array<int, 3> rgb = {image.channel("R"), image.channel("G"), image.channel("B")};
    if (*std::min_element(rgb.begin(), rgb.end()) >= 0) return rgb;
    if (grey < 0) throw Error(ErrorCode::kUnsupported, "a texture needs channels R, G and B, or Y");
    return {grey, grey, grey};
}

// Gives `pixel` the mean colour of its neighbours that have one; whether there are any.
bool mix_neighbours(Image& out, const std::vector<std::uint8_t>& has_color, int x, int y) {
    Vec3f sum(0, 0, 0);
    float count = 0;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, out.height - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, out.width - 1); ++u) {
            if (!has_color[static_cast<std::size_t>(v) * static_cast<std::size_t>(out.width) +
                           static_cast<std::size_t>(u)])
                continue;
            sum += Eigen::Map<const Vec3f>(out.pixel(u, v));
            ++count;
        }
    if (count > 0) Eigen::Map<Vec3f>(out.pixel(x, y)) = sum / count;
    return count > 0;
}

// Ring by ring, each from those before alone: no order of pixels counts.
void spread_colors(Image& out, const Mask& mask) {
    std::vector<std::uint8_t> has_color = mask.inside;
    for (int ring = 0; ring < kSpread; ++ring) {
        std::vector<std::size_t> added;
        for (std::size_t i = 0; i < has_color.size(); ++i) {
            const auto width = static_cast<std::size_t>(out.width);
            if (!has_color[i] &&
                mix_neighbours(out, has_color, static_cast<int>(i % width), static_cast<int>(i / width)))
                added.push_back(i);
        }
        for (const std::size_t i : added) has_color[i] = 1;
    }
    Vec3d sum(0, 0, 0);
    for (std::size_t i = 0; i < has_color.size(); ++i)
        if (mask.inside[i]) sum += Eigen::Map<const Vec3f>(out.data.data() + 4 * i).cast<double>();
    const Vec3f mean = (sum / static_cast<double>(std::max<std::int64_t>(mask.count(), 1))).cast<float>();
    for (std::size_t i = 0; i < has_color.size(); ++i)
        if (!has_color[i]) Eigen::Map<Vec3f>(out.data.data() + 4 * i) = mean;
}

}  // namespace

Image texture_image(const Image& image, const Mask& mask) {
    assert(mask.empty() || mask.inside.size() == image.pixel_count());
    const std::array<int, 3> rgb = color_channels(image);
    Image out = make_image(image.width, image.height, mask.empty() ? 3 : 4);
    const auto from_step = static_cast<std::size_t>(image.channels);
    const auto to_step = static_cast<std::size_t>(out.channels);
    parallel_blocks(0, image.height, kGrainRows, [&](int first, int last) {
        const auto width = static_cast<std::size_t>(image.width);
        for (std::size_t i = static_cast<std::size_t>(first) * width;
             i < static_cast<std::size_t>(last) * width; ++i) {
            const float* from = image.data.data() + i * from_step;
            float* to = out.data.data() + i * to_step;
            Vec3f color(from[rgb[0]], from[rgb[1]], from[rgb[2]]);
            if (image.color_space != ColorSpace::kSrgb)
                color = encoded_from_linear(ColorSpace::kSrgb, linear_from_encoded(image.color_space, color));
            Eigen::Map<Vec3f>{to} = color.cwiseMax(0.0f).cwiseMin(1.0f);
            if (!mask.empty()) to[3] = mask.contains(i) ? 1.0f : 0.0f;
        }
    });
    if (!mask.empty()) spread_colors(out, mask);
    return out;
}

}  // namespace imgmesh
