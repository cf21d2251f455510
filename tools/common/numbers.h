// Reads numbers from text, strictly: anything but a number in range is refused with Error(kBadArgument), in a
// line that names the option, the value and what is expected.
#pragma once

#include <cstdint>
#include <string>

#include "libcore/base/grid.h"
#include "libcore/base/range.h"

namespace imgmesh {

/// Reads `text` as a value of option `name`: decimal digits; no sign except '-', no space, no other base.
std::int64_t parse_count(const std::string& name, const std::string& text, const CountRange& range);
/// Reads a decimal number with optional exponent; neither infinite nor nan.
double parse_number(const std::string& name, const std::string& text, const NumberRange& range);
/// Reads the size of an image, as in 640x480: each side from 1 to `most_side`, and at most `most_pixels`.
GridSize parse_size(const std::string& name, const std::string& text, int most_side,
                    std::int64_t most_pixels);

}  // namespace imgmesh
