// read_image(): reads the file's bytes, probes them, runs one of the decoders, and does what all images need.
#include <algorithm>
#include <array>
#include <cmath>

#include "formats/files/atomic_file.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/image_io.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// Above any image within the default limits, and far below the memory of a machine.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{8} << 30;

// Where a displayed pixel is stored, as bits (EXIF 2.3, tag Orientation): first the axes are exchanged, then
// each may be reversed.
struct Orientation {
    bool exchange, backwards_x, backwards_y;
};
constexpr std::array<Orientation, 9> kOrientations = {{{false, false, false},  // 0: none is given
                                                       {false, false, false},
                                                       {false, true, false},
                                                       {false, true, true},
                                                       {false, false, true},
                                                       {true, false, false},
                                                       {true, false, true},
                                                       {true, true, true},
                                                       {true, true, false}}};

Image displayed(Image stored, int orientation) {
    if (orientation < 2 || orientation > 8) return stored;
    const Orientation o = kOrientations[static_cast<std::size_t>(orientation)];
    Image out = stored;
    if (o.exchange) std::swap(out.width, out.height);
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x) {
            int from_x = o.exchange ? y : x, from_y = o.exchange ? x : y;
            if (o.backwards_x) from_x = stored.width - 1 - from_x;
            if (o.backwards_y) from_y = stored.height - 1 - from_y;
            std::copy_n(stored.pixel(from_x, from_y), stored.channels, out.pixel(x, y));
        }
    }
    return out;
}

// Where alpha is zero, the colour is kept: it is light that covers nothing.
void divide_alpha_out(Image& image) {
    const int alpha = image.channel("A");
    if (alpha < 0) return;
    for (const char* name : {"R", "G", "B", "Y", "C", "M", "K"}) {
        const int color = image.channel(name);
        if (color < 0) continue;
        for (std::size_t i = 0; i < image.data.size(); i += static_cast<std::size_t>(image.channels)) {
            const float a = image.data[i + static_cast<std::size_t>(alpha)];
            if (a != 0) image.data[i + static_cast<std::size_t>(color)] /= a;
        }
    }
}

void check_finite(const std::string& path, const Image& image) {
    const auto bad =
        std::find_if(image.data.begin(), image.data.end(), [](float x) { return !std::isfinite(x); });
    if (bad == image.data.end()) return;
    const auto index = static_cast<std::size_t>(bad - image.data.begin());
    const auto channels = static_cast<std::size_t>(image.channels),
               width = static_cast<std::size_t>(image.width);
    const std::size_t pixel = index / channels;
    throw Error(ErrorKind::kBadFile,
                cat(path, ": channel ", printable(image.channel_names[index % channels]), " of pixel (",
                    pixel % width, ", ", pixel / width, ") is not a finite number"));
}

DecodedPicture decode(const std::string& path, const ReadImageOptions& options) {
    const ImageLimits& limits = options.limits;
    // A device or a pipe has no size to check beforehand. No more is read than the pixels could need.
    constexpr std::uint64_t kOther = std::uint64_t{64} << 20;  // profiles, previews, metadata
    const std::uint64_t most = kOther + static_cast<std::uint64_t>(limits.max_pixels) *
                                            static_cast<std::uint64_t>(limits.max_channels) * sizeof(float);
    std::vector<std::uint8_t> bytes = read_file(path, std::min(kMaxFileBytes, most));
    const PictureFile file{path, bytes, probe_picture(path, bytes), options};
    switch (file.claim.format) {
        case PictureFormat::kExr:
            return decode_exr(file);
        case PictureFormat::kWebp:
            return decode_webp(file);
        case PictureFormat::kPng:
            return decode_png(file);
        case PictureFormat::kTiff:
            return decode_tiff(file);
        default:
            return decode_with_oiio(file);
    }
}

}  // namespace

ReadImage read_image_file(const std::string& path, const ReadImageOptions& options) {
    DecodedPicture picture = decode(path, options);
    if (picture.associated_alpha) divide_alpha_out(picture.image);
    check_finite(path, picture.image);
    settle_color(picture.color, options.color_space, picture.image, picture.warnings);
    return {displayed(std::move(picture.image), picture.orientation), std::move(picture.warnings)};
}

Image read_image(const std::string& path, const ReadImageOptions& options) {
    return read_image_file(path, options).image;
}

}  // namespace imgmesh
