// The figures of CIE 15 that colour spaces share.
#pragma once

namespace imgmesh {

// L* over Y is a line up to kLinearLimit and a cube root above it; L* is 8 where they meet.
inline constexpr double kLinearSlope = 24389.0 / 27.0;   ///< L* per Y on the line
inline constexpr double kLinearLimit = 216.0 / 24389.0;  ///< Y where the branches meet

// The white point D65, as sRGB has it: x = 0.3127, y = 0.3290.
inline constexpr double kWhiteX = 0.3127, kWhiteY = 0.3290;
/// u' and v' of white.
inline constexpr double kWhiteU = 4 * kWhiteX / (-2 * kWhiteX + 12 * kWhiteY + 3);
inline constexpr double kWhiteV = 9 * kWhiteY / (-2 * kWhiteX + 12 * kWhiteY + 3);

}  // namespace imgmesh
