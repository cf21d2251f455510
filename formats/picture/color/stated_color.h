// The colour space of an image from the statements in its file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

struct StatedColor {
    std::vector<std::uint8_t> icc;  ///< a profile; empty for none
    float gamma = 0;                ///< linear = value^gamma; 0 if not stated
    std::string name;               ///< of a colour space; empty for none
};

/// Returns the profile's colour space, else the gamma's, else that of the name; nothing if none of them is
/// one of ours. If the gamma is none of ours, the samples are converted to 2.2, except alpha.
std::optional<ColorSpace> stated_color_space(const StatedColor& stated, Image& image);

}  // namespace imgmesh
