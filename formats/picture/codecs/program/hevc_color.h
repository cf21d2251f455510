// Colours that a HEVC stream states itself.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "formats/picture/color/code_points.h"

namespace imgmesh {

/// Returns the code points of the first image of colour in a HEIC file whose stream states them, for files
/// without a statement of their own. Safe for any bytes. Source: ITU-T H.265, 7.3.2.2 and annex E; ISO/IEC
/// 14496-15, 8.3.3.
std::optional<CodePoints> hevc_code_points(std::span<const std::uint8_t> file);

}  // namespace imgmesh
