// The markers of a JPEG file: its frame, what its scans hold, and the metadata that imgmesh obeys.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace imgmesh {

struct JpegMarkers {
    int width = 0, height = 0, channels = 0;
    int precision = 0;  ///< bits of a sample
    std::uint8_t frame =
        0;          ///< the marker of the frame: 0xC0 baseline, 0xC2 progressive, 0xC9 arithmetic ...
    int scans = 0;  ///< that have any data
    std::size_t packed = 0;  ///< bytes of all scans
    bool ends = false;       ///< with EOI
    bool whole = false;      ///< every coefficient of every channel is in some scan, to its last bit
    std::vector<std::uint8_t> icc;
    int orientation = 0;     ///< 1 to 8; 0 if it is not said
    bool adobe_rgb = false;  ///< EXIF says so
    std::vector<std::string> warnings;

    bool is_progressive() const { return (frame & 3) == 2; }
    bool is_arithmetic() const { return frame >= 0xC9; }
};

/// Goes through the first image of the file. Stray bytes between markers are stepped over. Safe for any
/// bytes.
JpegMarkers jpeg_markers(std::span<const std::uint8_t> bytes);

}  // namespace imgmesh
