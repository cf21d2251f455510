#include "formats/picture/decode/bmp_color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "formats/files/byte_reader.h"

namespace imgmesh {
namespace {

constexpr std::uint32_t kCalibrated = 0, kSrgb = 0x73524742, kEmbedded = 0x4D424544, kLinked = 0x4C494E4B;

// Gamma as 16.16, of red, green and blue; nothing if none or if they differ by more than rounding.
float gamma_of(const ByteReader& header) {
    constexpr double kOne = 65536, kTolerance = 0.01;
    const double red = header.number_at(96, 4) / kOne, green = header.number_at(100, 4) / kOne,
                 blue = header.number_at(104, 4) / kOne;
    const bool alike = std::max({red, green, blue}) - std::min({red, green, blue}) < kTolerance;
    if (!alike || green < 0.1 || green > 10) return 0;
    return static_cast<float>(green < 1 ? 1 / green : green);
}

// The end points of red, green and blue as X, Y and Z in 2.30; or as x, y and z, whose sum is 1 and which
// leave the white open. Nothing if there are none.
std::optional<Chromaticities> chromaticities_of(const ByteReader& header) {
    constexpr double kOne = 1 << 30, kTolerance = 0.01;
    std::array<std::array<double, 3>, 3> colors;
    std::array<double, 3> white = {};
    std::array<double, 6> xy;
    bool ratios = true;
    for (std::size_t i = 0; i < 3; ++i) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            colors[i][k] = header.number_at(60 + 12 * i + 4 * k, 4) / kOne;
            white[k] += colors[i][k];
            sum += colors[i][k];
        }
        if (sum <= 0) return std::nullopt;
        ratios = ratios && std::abs(sum - 1) < kTolerance;
        xy[2 * i] = colors[i][0] / sum;
        xy[2 * i + 1] = colors[i][1] / sum;
    }
    const double total = white[0] + white[1] + white[2];
    const double x = ratios ? 0.3127 : white[0] / total, y = ratios ? 0.3290 : white[1] / total;
    return Chromaticities{x, y, xy[0], xy[1], xy[2], xy[3], xy[4], xy[5]};
}

}  // namespace

void state_bmp_color(std::span<const std::uint8_t> bytes, StatedColor& color,
                     std::vector<std::string>& warnings) {
    const ByteReader header(bytes, ByteOrder::kLittle);
    const bool version5 = header.number_at(0, 4) >= 124;
    switch (header.number_at(56, 4)) {
        case kSrgb:
            color.name = "sRGB";
            break;
        case kCalibrated:
            color.gamma = gamma_of(header);
            color.chromaticities = chromaticities_of(header);
            break;
        case kLinked:
            warnings.push_back("its colour profile is in another file and was not used");
            break;
        case kEmbedded: {
            const std::size_t at = header.number_at(112, 4), size = header.number_at(116, 4);
            if (version5 && at >= 124 && size > 0 && at <= bytes.size() && size <= bytes.size() - at) {
                const auto profile = bytes.subspan(at, size);
                color.icc.assign(profile.begin(), profile.end());
            } else {
                warnings.push_back("its colour profile is not in the file");
            }
            break;
        }
        default:  // the system's own space
            break;
    }
}

}  // namespace imgmesh
