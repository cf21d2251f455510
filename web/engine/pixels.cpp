#include "web/engine/pixels.h"

#include <algorithm>

#include "formats/picture/sample_codes.h"
#include "libcore/base/error.h"

namespace imgmesh::web {
namespace {

// Sides beyond these are no canvas's either.
constexpr double kLargestSide = 1 << 20;

int side(const val& pixels, const char* name) {
    const val value = pixels[name];
    const double side = value.isNumber() ? value.as<double>() : 0;
    if (!(side >= 1 && side <= kLargestSide) || side != static_cast<int>(side))
        throw Error(ErrorKind::kBadArgument,
                    cat(name, ": expected a whole number from 1 to ", static_cast<int>(kLargestSide)));
    return static_cast<int>(side);
}

}  // namespace

std::vector<std::uint8_t> bytes_from(const val& array) {
    std::vector<std::uint8_t> bytes(array["length"].as<std::size_t>());
    val(emscripten::typed_memory_view(bytes.size(), bytes.data())).call<void>("set", array);
    return bytes;
}

Image image_from_pixels(const val& pixels) {
    const int width = side(pixels, "width"), height = side(pixels, "height");
    const std::size_t count = std::size_t(width) * std::size_t(height);
    if (pixels["data"]["length"].as<double>() != 4.0 * width * height)
        throw Error(ErrorKind::kBadArgument, cat("data: expected ", 4.0 * width * height, " values for ",
                                                 width, "x", height, " pixels"));
    const std::vector<std::uint8_t> codes = bytes_from(pixels["data"]);
    bool opaque = true;
    for (std::size_t i = 0; i < count && opaque; ++i) opaque = codes[4 * i + 3] == 255;
    Image image = make_image(width, height, opaque ? 3 : 4);
    if (!opaque) {
        floats_from_codes(codes, image.data);
        return image;
    }
    std::vector<std::uint8_t> rgb(3 * count);
    for (std::size_t i = 0; i < count; ++i) std::copy_n(codes.data() + 4 * i, 3, rgb.data() + 3 * i);
    floats_from_codes(rgb, image.data);
    return image;
}

val pixels_from_image(const Image& image) {
    const std::size_t count = image.pixel_count(), channels = std::size_t(image.channels);
    const std::vector<std::uint8_t> codes = codes8_from_floats(image.data);
    const bool grey = image.channel("Y") == 0;
    const int alpha = image.channel("A");
    std::vector<std::uint8_t> rgba(4 * count, 255);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t c = 0; c < 3; ++c) rgba[4 * i + c] = codes[i * channels + (grey ? 0 : c)];
        if (alpha >= 0) rgba[4 * i + 3] = codes[i * channels + std::size_t(alpha)];
    }
    val pixels = val::object();
    pixels.set("width", image.width);
    pixels.set("height", image.height);
    pixels.set("data", typed_array(rgba, "Uint8ClampedArray"));
    return pixels;
}

}  // namespace imgmesh::web
