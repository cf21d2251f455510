// What the SVG drawings share: short numbers, colours, and where vertices are drawn.
#pragma once

#include <string>
#include <vector>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// A number with at most two decimals, as short as SVG allows: "12", "-.5", "3.25". Hundredths of a pixel are
/// far finer than what one sees, and coarser than the 1/32 that positions are multiples of.
void append_number(std::string& out, double value);
/// The command, a letter, and its point.
void append_point(std::string& out, char command, const Vec2d& p);
/// A colour in L*u*v* as "#rrggbb" in sRGB.
void append_hex(std::string& out, const Vec3f& luv);

/// The vertices of `mesh`; those on the image's sides move out by half a pixel, to where the outermost
/// pixels end.
std::vector<Vec2d> outward(const BaseMesh& mesh, const SourceInfo& source);

}  // namespace imgmesh
