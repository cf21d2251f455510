// Luminance and chroma of an EXR as RGB. Internal to this folder.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfInputPart.h>

#include <functional>
#include <string>

#include "formats/picture/decode/exr_choice.h"

namespace imgmesh {

/// Throws Error(kUnsupported) for luminance that is subsampled, and for chroma that is not, 2 x 2.
void check_exr_chroma(const std::string& path, const Imf::ChannelList& channels, const ExrChoice& choice);

/// Calls take(y, rgb) with the rows `first` to `last` of the part's data window, from the top, `rgb` being
/// three floats a pixel of the whole row. They are those of OpenEXR's RgbaInputFile, which reads neither
/// parts nor floats, and have the primaries of the file. Reads up to 14 more rows on either side, and
/// holds 27.
void read_exr_chroma(Imf::InputPart& part, const ExrChoice& choice, int first, int last,
                     const std::function<void(int, const float*)>& take);

}  // namespace imgmesh
