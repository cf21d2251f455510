// What SVG drawings share: short numbers, points and colours.
#pragma once

#include <string>

#include "libcore/base/types.h"

namespace imgmesh {

/// Returns a number with at most two decimals, as short as SVG allows: "12", "-.5", "3.25". A hundredth of a
/// pixel is far finer than one can see, and finer than the step of positions, 1/32 pixel.
void append_number(std::string& out, double value);
/// Returns a path command (a letter) and its point.
void append_point(std::string& out, char command, const Vec2d& p);
/// Appends red, green and blue as "#rrggbb", each rounded to a whole number from 0 to 255.
void append_hex(std::string& out, const Vec3d& codes);

}  // namespace imgmesh
