// The runs of a compressed BMP.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/picture/decode/bmp_header.h"

namespace imgmesh {

/// Returns the indices of all pixels, row by row from the top. Pixels that the runs step over have index 0,
/// as in most readers; what goes beyond a row is dropped; warnings tell both. Throws Error(kBadFile) if the
/// runs end before the last pixel without saying that they end. Source: "Bitmap Compression" of the Windows
/// documentation.
std::vector<std::uint16_t> read_bmp_runs(const std::string& path, const BmpHeader& header,
                                         std::span<const std::uint8_t> bytes,
                                         std::vector<std::string>& warnings);

}  // namespace imgmesh
