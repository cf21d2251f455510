// Reads what imgmesh obeys of EXIF and XMP metadata.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace imgmesh {

struct ExifFacts {
    int orientation = 0;     ///< 1 to 8; 0 if it is not said
    bool adobe_rgb = false;  ///< the colours are Adobe RGB (1998), as cameras say it (DCF 2.0, R03)
};

/// Reads EXIF bytes (a TIFF header and its directories, perhaps after "Exif\0\0"). Safe for any bytes.
/// Source: EXIF 2.3, 4.6.
ExifFacts exif_facts(std::span<const std::uint8_t> exif);

/// Returns tiff:Orientation of an XMP packet, 1 to 8, whether an attribute or an element; 0 if it is not
/// said.
int xmp_orientation(std::string_view xmp);

}  // namespace imgmesh
