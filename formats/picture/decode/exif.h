// Reads the orientation of an image from EXIF metadata.
#pragma once

#include <cstdint>
#include <span>

namespace imgmesh {

/// Returns the orientation, 1 to 8, of EXIF bytes (a TIFF header and its directories, perhaps after
/// "Exif\0\0"), else 1. Safe for any bytes. Source: EXIF 2.3, 4.6, tag 0x0112 of the first directory.
int exif_orientation(std::span<const std::uint8_t> exif);

}  // namespace imgmesh
