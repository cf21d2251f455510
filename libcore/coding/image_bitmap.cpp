#include "libcore/coding/image_bitmap.h"

#include <cmath>

#include "libcore/image/texture_image.h"

namespace imgmesh {
namespace {

constexpr float kWhite = 255;

std::uint8_t code_of(float sample) {
    return static_cast<std::uint8_t>(std::lround(sample * kWhite));
}

}  // namespace

Bitmap bitmap_from_image(const Image& image) {
    const Image srgb = texture_image(image, {}, TextureAlpha::kOwn);
    std::vector<std::uint8_t> codes;
    codes.reserve(srgb.data.size());
    for (const float sample : srgb.data) codes.push_back(code_of(sample));
    const auto step = static_cast<std::size_t>(srgb.channels);
    bool grey = true, opaque = true;
    for (std::size_t i = 0; i < codes.size(); i += step) {
        grey = grey && codes[i] == codes[i + 1] && codes[i] == codes[i + 2];
        opaque = opaque && (step < 4 || codes[i + 3] == 255);
    }
    Bitmap picture{image.width, image.height, (grey ? 1 : 3) + (opaque ? 0 : 1), {}};
    picture.data.reserve(srgb.pixel_count() * static_cast<std::size_t>(picture.channels));
    for (std::size_t i = 0; i < codes.size(); i += step) {
        picture.data.push_back(codes[i]);
        if (!grey) picture.data.insert(picture.data.end(), {codes[i + 1], codes[i + 2]});
        if (!opaque) picture.data.push_back(codes[i + 3]);
    }
    return picture;
}

Image image_from_bitmap(const Bitmap& picture) {
    Image image = make_image(picture.width, picture.height, picture.channels);
    for (std::size_t i = 0; i < picture.data.size(); ++i)
        image.data[i] = static_cast<float>(picture.data[i]) / kWhite;
    return image;
}

}  // namespace imgmesh
