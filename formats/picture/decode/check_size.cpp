#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/picture/decode/picture_probe.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

Error broken(const std::string& path, const std::string& what) {
    return Error(ErrorKind::kBadFile, cat(path, ": ", what));
}

// Rounded up for what is needed and for what may be taken alike, in whole units, of which there are at least
// ten.
std::string rounded(double bytes) {
    constexpr double kMost = 1e18;  // no limit
    constexpr std::pair<double, const char*> kUnits[] = {{1e6, " MB"}, {1e3, " kB"}, {1, " bytes"}};
    const double shown = std::min(bytes, kMost);
    for (const auto& [size, name] : kUnits)
        if (shown >= 10 * size) return cat(static_cast<std::int64_t>(std::ceil(shown / size)), name);
    return cat(static_cast<std::int64_t>(shown), " bytes");
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
        throw broken(
            path,
            cat("the image is ", width, "x", height, ", at most ", limits.max_pixels, " pixels are read",
                limits.max_pixels_per_byte > 0 ? " from so small a file, unless a largest number is given"
                                               : ""));
    if (channels > limits.max_channels)
        throw broken(
            path, cat("the image has ", channels, " channels, at most ", limits.max_channels, " are read"));
    // RGBA at the largest size: more channels only in smaller images, or 64 would take 64 GB.
    if (width * height * channels > 4 * limits.max_pixels)
        throw broken(path, cat("the image is ", width, "x", height, " with ", channels, " channels, at most ",
                               4 * limits.max_pixels, " samples are read"));
    constexpr double kSampleBytes = 8;
    const double bytes = static_cast<double>(width * height) *
                         (kSampleBytes * static_cast<double>(channels) + limits.work_bytes);
    if (bytes > static_cast<double>(limits.max_memory))
        throw broken(
            path, cat("the image is ", width, "x", height, " with ", channels, " channels, for which about ",
                      rounded(bytes), " of memory are needed, at most ",
                      rounded(static_cast<double>(limits.max_memory)), " may be taken"));
}

ImageLimits limits_for_bytes(ImageLimits limits, std::uint64_t bytes) {
    constexpr std::int64_t kAlways = std::int64_t{1} << 22;
    constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;
    const std::int64_t per_byte = std::clamp<std::int64_t>(limits.max_pixels_per_byte, 0, 1 << 20);
    const std::int64_t most =
        std::max(kAlways, per_byte * static_cast<std::int64_t>(std::min(bytes, kMostBytes)));
    if (per_byte == 0 || most >= limits.max_pixels)
        limits.max_pixels_per_byte = 0;
    else
        limits.max_pixels = most;
    return limits;
}

void check_block_size(const std::string& path, std::int64_t width, std::int64_t height, std::int64_t channels,
                      ImageLimits limits) {
    limits.work_bytes = 0;
    check_size(path, width, height, channels, limits);
}

}  // namespace imgmesh
