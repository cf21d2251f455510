// Colours by the code points of ITU-T H.273, as PNG's cICP chunk and HEIF's nclx box state them.
#pragma once

#include <optional>

#include "formats/picture/color/lcms_profile.h"
#include "libcore/image/image.h"

namespace imgmesh {

struct CodePoints {
    int primaries = 2;  ///< 2: not stated
    int transfer = 2;
};

/// Whether the transfer is of high dynamic range: PQ (16) or HLG (18).
bool is_hdr(const CodePoints& codes);

/// Returns a profile of the primaries and the transfer; linear light for those of high dynamic range. What is
/// not stated counts as sRGB's. Returns nothing for reserved code points and those that no image of a camera
/// or screen has: generic film logarithms (9, 10) and XYZ (primaries 10).
LcmsProfile profile_from_code_points(const CodePoints& codes);

/// Converts samples of PQ or HLG to light relative to the white of paper and text: 203 cd/m2 are 1 (ITU-R
/// BT.2408). HLG is shown as on a screen of 1000 cd/m2. The primaries stay.
void decode_hdr(const CodePoints& codes, Image& image);

}  // namespace imgmesh
