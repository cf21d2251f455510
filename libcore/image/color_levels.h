// Coarser colours than those of 16-bit codes, which take fewer bytes in a file.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/base/types.h"

namespace imgmesh {

inline constexpr int kLeastColorLevels = 2, kMostColorLevels = 4096;

/// The 16-bit codes of linear RGB that each channel of a coarse colour may have: those of `count` equal steps
/// of the sRGB curve. Steps are about as visible in the dark as in the light, and 256 of them are the values
/// of 8-bit images.
class ColorLevels {
  public:
    /// count  kLeastColorLevels to kMostColorLevels
    explicit ColorLevels(int count);

    /// Returns the level whose sRGB value is nearest to that of the linear `code`.
    std::uint16_t nearest(std::uint16_t code) const;
    /// Returns the colour, again L*u*v*, that has the nearest level to in_gamut(luv) in each of R, G and B.
    /// quantized_color() of the result is the result, bit for bit.
    Vec3f rounded(const Vec3f& luv) const;

  private:
    std::vector<std::uint16_t> code_;   // of each level
    std::vector<std::uint16_t> first_;  // the least code whose nearest level it is
};

}  // namespace imgmesh
