// EXIF metadata, as far as it says how an image stands.
#pragma once

#include <cstdint>
#include <span>

namespace imgmesh {

/// The orientation, 1 to 8, of EXIF bytes (a TIFF header and its directories, perhaps behind "Exif\0\0"); 1
/// where there is none. Safe for any bytes. Source: EXIF 2.3, 4.6, tag 0x0112 of the first directory.
int exif_orientation(std::span<const std::uint8_t> exif);

}  // namespace imgmesh
