// Primaries of linear RGB by their chromaticities.
#pragma once

#include <string>

#include "libcore/image/image.h"

namespace imgmesh {

/// x and y of CIE 1931.
struct Chromaticity {
    double x, y;
};

struct Primaries {
    Chromaticity red, green, blue, white;
};

inline constexpr Primaries kRec709Primaries{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};
/// AP0, the primaries of ACES2065-1 (SMPTE ST 2065-1).
inline constexpr Primaries kAcesPrimaries{
    {0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}};

/// Whether both mean the same colours, within what files round to (0.001).
bool same_primaries(const Primaries& a, const Primaries& b);

/// Converts R, G and B, which are linear, from one to the other. The white of one becomes that of the other
/// by Bradford's adaptation (ICC.1:2022, annex E). Other channels stay, and so does an image without all
/// three. Values below 0 and above 1 are kept. `path` is for the text of Error(kBadFile), which is thrown for
/// primaries that span no triangle, or a white without light.
void convert_primaries(const std::string& path, const Primaries& from, const Primaries& to, Image& image);

}  // namespace imgmesh
