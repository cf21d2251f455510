#include "tools/build_memory.h"

#include <algorithm>

#include "tools/common/memory.h"

namespace imgmesh {
namespace {

// Measured as in docs/limits.md. Encoders work on rows and on blocks of a fixed size.
constexpr double kEncoderMemory = 14e6;
constexpr double kBuildBytes = 62, kChannelBytes = 8;
constexpr double kLevelBytes = 29;         // of each level after the first
constexpr double kManyFeatureBytes = 104;  // quadrics of more features than a colour has
constexpr std::size_t kFewFeatures = 3;

std::size_t features(const Image& image, const BuildParams& params) {
    if (!params.channels.empty()) return params.channels.size();
    const auto channels = static_cast<std::size_t>(image.channels);
    return params.values ? channels : std::min(channels, kFewFeatures);
}

}  // namespace

double build_bytes_of_pixel(const BuildParams& params) {
    const PyramidParams& levels = params.levels;
    const std::size_t count =
        std::max({static_cast<std::size_t>(levels.count), levels.faces.size(), levels.errors.size()});
    return kBuildBytes + kLevelBytes * static_cast<double>(count - 1);
}

double build_memory(const Image& image, const BuildParams& params) {
    double bytes_of_pixel = kChannelBytes * image.channels + build_bytes_of_pixel(params);
    if (features(image, params) > kFewFeatures) bytes_of_pixel += kManyFeatureBytes;
    return kProgramMemory + kEncoderMemory + static_cast<double>(image.pixel_count()) * bytes_of_pixel;
}

}  // namespace imgmesh
