// Images of indices into a palette.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

/// R, G, B and A, 8 bits each.
using PaletteColor = std::array<std::uint8_t, 4>;

/// Returns the image of `indices`, row by row from the top: Y if the palette is grey, else R, G and B, and A
/// if `alpha`. Indices beyond the palette become opaque black, which a warning tells.
Image image_from_palette(int width, int height, std::span<const std::uint16_t> indices,
                         std::span<const PaletteColor> palette, bool alpha,
                         std::vector<std::string>& warnings);

/// Removes an alpha that is 0 in every pixel, which writers leave behind that know no alpha, and warns of it.
void drop_empty_alpha(Image& image, std::vector<std::string>& warnings);

}  // namespace imgmesh
