// What a JPEG 2000 file says of its size.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "formats/picture/decode/picture_probe.h"

namespace imgmesh {

/// Sets the size and the channels of `claim` from the SIZ marker of the codestream that a decoder reads: that
/// of the first jp2c box, or the file itself. No other box counts, whatever it holds. Throws Error(kBadFile)
/// if there is none, if the decoder would take more memory for the tiles than for their samples, or if
/// it would step through more packets than the file can hold.
void claim_jpeg2000(const std::string& path, std::span<const std::uint8_t> bytes, PictureClaim& claim);

}  // namespace imgmesh
