#include "formats/picture/decode/picture_probe.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

Error broken(const std::string& path, const std::string& what) {
    return Error(ErrorKind::kBadFile, cat(path, ": ", what));
}

}  // namespace

void check_size(const std::string& path, std::int64_t width, std::int64_t height, std::int64_t channels,
                const ImageLimits& limits) {
    if (width < 1 || height < 1 || channels < 1)
        throw broken(path, cat("the image is ", width, "x", height, " with ", channels, " channels"));
    if (width > limits.max_side || height > limits.max_side)
        throw broken(path, cat("the image is ", width, "x", height, ", at most ", limits.max_side,
                               " pixels a side are read"));
    if (width * height > limits.max_pixels)
        throw broken(path, cat("the image is ", width, "x", height, ", at most ", limits.max_pixels,
                               " pixels are read"));
    if (channels > limits.max_channels)
        throw broken(
            path, cat("the image has ", channels, " channels, at most ", limits.max_channels, " are read"));
    // RGBA at the largest size: more channels only in smaller images, or 64 would take 64 GB.
    if (width * height * channels > 4 * limits.max_pixels)
        throw broken(path, cat("the image is ", width, "x", height, " with ", channels, " channels, at most ",
                               4 * limits.max_pixels, " samples are read"));
}

}  // namespace imgmesh
