// Luminance and chroma of an EXR as RGB. Internal to this folder.
#pragma once

#include <OpenEXR/ImfInputPart.h>

#include <functional>

#include "formats/picture/decode/exr_choice.h"

namespace imgmesh {

/// Calls take(y, rgb) with every row of the part's data window, from the top, `rgb` being three floats a
/// pixel. They are those of OpenEXR's RgbaInputFile, which reads neither parts nor floats, and have the
/// primaries of the file.
/// Throws Error(kUnsupported) for chroma that is not subsampled 2 x 2.
void read_exr_chroma(const std::string& path, Imf::InputPart& part, const ExrChoice& choice,
                     const std::function<void(int, const float*)>& take);

}  // namespace imgmesh
