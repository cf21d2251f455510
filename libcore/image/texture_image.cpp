#include "libcore/image/texture_image.h"

#include <algorithm>
#include <cassert>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

// How far colours spread outside the mask [pixels]. At an eighth of its size a texture still mixes pixels
// inside only with these.
constexpr int kSpread = 8;
constexpr int kGrainRows = 16;

std::array<int, 3> color_channels(const Image& image) {
    const int grey = image.channel("Y");
    const std::array<int, 3> rgb = {image.channel("R"), image.channel("G"), image.channel("B")};
    if (*std::min_element(rgb.begin(), rgb.end()) >= 0) return rgb;
    if (grey < 0) throw Error(ErrorKind::kUnsupported, "a texture needs channels R, G and B, or Y");
    return {grey, grey, grey};
}

constexpr std::uint8_t kClear = 0, kColored = 1, kNext = 2;  // states of a pixel; kNext: in the next ring

class Spread {
  public:
    Spread(Image& out, const Mask& mask) : out_(out), state_(mask.values) {
        for (std::uint8_t& state : state_) state = state ? kColored : kClear;
    }

    // Each ring depends only on the rings before it, so the order of pixels does not matter.
    void run() {
        std::vector<std::size_t> ring;
        for (std::size_t i = 0; i < state_.size(); ++i) {
            bool touches = false;
            if (state_[i] == kClear) around(i, [&](std::size_t n) { touches |= state_[n] == kColored; });
            if (touches) ring.push_back(i);
        }
        for (int k = 0; k < kSpread && !ring.empty(); ++k) {
            for (const std::size_t i : ring) state_[i] = kNext;
            for (const std::size_t i : ring) mix(i);
            for (const std::size_t i : ring) state_[i] = kColored;
            std::vector<std::size_t> next;
            for (const std::size_t i : ring)
                around(i, [&](std::size_t n) {
                    if (state_[n] != kClear) return;
                    state_[n] = kNext;
                    next.push_back(n);
                });
            ring = std::move(next);
        }
        for (const std::size_t i : ring) state_[i] = kClear;
    }

    bool reached(std::size_t i) const { return state_[i] == kColored; }

  private:
    // Calls visit(j) for the pixels around pixel i, and for itself.
    template <typename Visit>
    void around(std::size_t i, Visit&& visit) const {
        const int x = out_.x_of(i), y = out_.y_of(i);
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, out_.height - 1); ++v)
            for (int u = std::max(x - 1, 0); u <= std::min(x + 1, out_.width - 1); ++u)
                visit(out_.index(u, v));
    }

    // The mean colour of the neighbours that have one; there is at least one.
    void mix(std::size_t i) {
        Vec3f sum(0, 0, 0);
        float count = 0;
        around(i, [&](std::size_t n) {
            if (state_[n] != kColored) return;
            sum += Eigen::Map<const Vec3f>(out_.pixel(n));
            ++count;
        });
        Eigen::Map<Vec3f>(out_.pixel(i)) = sum / count;
    }

    Image& out_;
    std::vector<std::uint8_t> state_;
};

void spread_colors(Image& out, const Mask& mask) {
    Spread spread(out, mask);
    spread.run();
    Vec3d sum(0, 0, 0);
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (mask[i]) sum += Eigen::Map<const Vec3f>(out.pixel(i)).cast<double>();
    const Vec3f mean = (sum / double(std::max<std::int64_t>(mask.count(), 1))).cast<float>();
    for (std::size_t i = 0; i < mask.size(); ++i)
        if (!spread.reached(i)) Eigen::Map<Vec3f>(out.pixel(i)) = mean;
}

}  // namespace

Image texture_image(const Image& image, const Mask& mask, TextureAlpha kind) {
    assert(mask.empty() || mask.size() == image.pixel_count());
    const std::array<int, 3> rgb = color_channels(image);
    const int alpha = kind == TextureAlpha::kOwn ? image.channel("A") : -1;
    const bool clear = !mask.empty() || alpha >= 0;
    Image out = make_image(image.width, image.height, clear ? 4 : 3);
    parallel_blocks(0, image.height, kGrainRows, [&](int first, int last) {
        const std::size_t end = as_index(last) * as_index(image.width);
        for (std::size_t i = image.row_begin(first); i < end; ++i) {
            const float* from = image.pixel(i);
            float* to = out.pixel(i);
            Vec3f color(from[rgb[0]], from[rgb[1]], from[rgb[2]]);
            if (image.color_space != ColorSpace::kSrgb)
                color = encoded_from_linear(ColorSpace::kSrgb, linear_from_encoded(image.color_space, color));
            Eigen::Map<Vec3f>{to} = color.cwiseMax(0.0f).cwiseMin(1.0f);
            if (clear)
                to[3] = !mask.contains(i) ? 0.0f : alpha < 0 ? 1.0f : std::clamp(from[alpha], 0.0f, 1.0f);
        }
    });
    if (!mask.empty()) spread_colors(out, mask);
    return out;
}

}  // namespace imgmesh
