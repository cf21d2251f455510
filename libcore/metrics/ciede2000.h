// CIEDE2000, the colour difference that the CIE recommends for small differences.
#pragma once

#include "libcore/base/types.h"

namespace imgmesh {

/// Converts linear RGB (sRGB primaries, white = 1,1,1) to CIE 1976 L*a*b* under D65 (CIE 15).
Vec3d lab_from_linear(const Vec3f& linear);

/// The difference of two L*a*b* colours with kL = kC = kH = 1: Sharma, Wu, Dalal, "The CIEDE2000
/// color-difference formula: implementation notes, supplementary test data, and mathematical observations",
/// Color Research and Application 30(1), 2005. About 1 is just visible. Symmetric; 0 only for equal colours.
double ciede2000(const Vec3d& lab_1, const Vec3d& lab_2);

}  // namespace imgmesh
