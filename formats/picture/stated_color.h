// The colour space of an image from what its file says.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "libcore/image/image.h"

namespace imgmesh {

struct StatedColor {
    std::span<const std::uint8_t> icc = {};  ///< a profile; empty for none
    float gamma = 0;                         ///< light is value^gamma; 0 where none is said
    std::string_view name = {};              ///< of a colour space; empty for none
};

/// The profile's colour space, else the gamma's, else that of the name; nothing where none of them is one of
/// ours. The samples of an image whose gamma is none of ours are brought to 2.2, alpha aside.
std::optional<ColorSpace> stated_color_space(const StatedColor& stated, Image& image);

}  // namespace imgmesh
