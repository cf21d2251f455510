// What the SVG drawings share: short numbers, colours, and the places of vertices.
#pragma once

#include <string>
#include <vector>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Returns a number with at most two decimals, as short as SVG allows: "12", "-.5", "3.25". A hundredth of a
/// pixel is far finer than one can see, and finer than the step of positions, 1/32 pixel.
void append_number(std::string& out, double value);
/// Returns a path command (a letter) and its point.
void append_point(std::string& out, char command, const Vec2d& p);
/// Appends red, green and blue as "#rrggbb", each rounded to a whole number from 0 to 255.
void append_hex(std::string& out, const Vec3d& codes);

/// Returns the vertices of a level's mesh. Those on the image's sides move out by half a pixel, to the outer
/// edge of the outermost pixels, and those on the boundary of a masked image as outer_positions() has them.
std::vector<Vec2d> outward(const Level& level, const SourceInfo& source);

}  // namespace imgmesh
