// Colour channels as they are coded: one of lightness and two of colour, orthonormal, so that an error weighs
// as much after the transform as before it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace imgmesh::coding {

/// Takes red, green and blue to (R+G+B)/sqrt3, (R-B)/sqrt2, (R-2G+B)/sqrt6. Other numbers of channels than 3
/// and 4 stay as they are, and so does the alpha behind the colours.
inline void to_coded(std::span<double> channels) {
    if (channels.size() < 3) return;
    constexpr double kThird = 0.57735026918962576451, kHalf = 0.70710678118654752440,
                     kSixth = 0.40824829046386301637;
    const double red = channels[0], green = channels[1], blue = channels[2];
    channels[0] = kThird * (red + green + blue);
    channels[1] = kHalf * (red - blue);
    channels[2] = kSixth * (red - 2 * green + blue);
}

/// The inverse, in integers. No channel may lie beyond -32768 to 32767.
inline void from_coded(std::span<std::int32_t> channels) {
    if (channels.size() < 3) return;
    constexpr std::int32_t kThird = 9459, kHalf = 11585, kSixth = 6689, kTwoSixths = 13377;  // in 1/2^14
    const std::int32_t light = kThird * channels[0] + (1 << 13);
    const std::int32_t across = kHalf * channels[1], along = kSixth * channels[2];
    channels[1] = (light - kTwoSixths * channels[2]) >> 14;
    channels[0] = (light + across + along) >> 14;
    channels[2] = (light - across + along) >> 14;
}

}  // namespace imgmesh::coding
