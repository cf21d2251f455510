// read_image(): reads the file's bytes, probes them, runs one of the decoders, and finishes what it gives.
#include <algorithm>

#include "formats/files/atomic_file.h"
#include "formats/picture/decode/finish_picture.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/image_io.h"

namespace imgmesh {
namespace {

// Above any image within the default limits, and far below the memory of a machine.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{8} << 30;

std::vector<std::uint8_t> read_bytes(const std::string& path, const ImageLimits& limits) {
    // A device or a pipe has no size to check beforehand. No more is read than the pixels could need.
    constexpr std::uint64_t kOther = std::uint64_t{64} << 20;  // profiles, previews, metadata
    const std::uint64_t most = kOther + static_cast<std::uint64_t>(limits.max_pixels) *
                                            static_cast<std::uint64_t>(limits.max_channels) * sizeof(float);
    return read_file(path, std::min(kMaxFileBytes, most));
}

}  // namespace

DecodedPicture decode_picture(const std::string& path, std::span<std::uint8_t> bytes,
                              const ReadImageOptions& options) {
    ReadImageOptions within = options;
    within.limits = limits_for_bytes(options.limits, bytes.size());
    const PictureFile file{path, bytes, probe_picture(path, bytes), within};
    switch (file.claim.format) {
        case PictureFormat::kExr:
            return decode_exr(file);
        case PictureFormat::kWebp:
            return decode_webp(file);
        case PictureFormat::kJpeg:
            return decode_jpeg(file);
        case PictureFormat::kPng:
            return decode_png(file);
        case PictureFormat::kTiff:
            return decode_tiff(file);
        case PictureFormat::kBmp:
            return decode_bmp(file);
        case PictureFormat::kPnm:
            return decode_pnm(file);
        case PictureFormat::kTga:
            return decode_tga(file);
        default:
            return decode_with_codecs(file);
    }
}

ReadImage read_image_file(const std::string& path, const ReadImageOptions& options) {
    std::vector<std::uint8_t> bytes = read_bytes(path, options.limits);
    return finish_picture(path, decode_picture(path, bytes, options), options);
}

Image read_image(const std::string& path, const ReadImageOptions& options) {
    return read_image_file(path, options).image;
}

}  // namespace imgmesh
