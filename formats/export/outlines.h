// Outlines of an image's visible pixels as JSON and SVG. The same outlines give the same bytes. All take
// O(corners) time.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "libcore/base/grid.h"
#include "libcore/base/types.h"
#include "libcore/mesh/loop.h"

namespace imgmesh {

/// What the outlines are of, and how they were made.
struct OutlineFacts {
    GridSize size;  ///< of the image
    double tolerance = 0;
    OutlineSide side = OutlineSide::kOut;
    std::string input;      ///< the file that they were made from
    std::string generator;  ///< such as "imgmesh-convert 0.1.0"
};

/// JSON, described by schemas/imgmesh-convert.outline.schema.json: for each part its outer ring,
/// counter-clockwise on screen, and its holes, clockwise; points in pixels from the image's top-left corner.
///
/// loops  as simplified_outline() of libcore/mesh/outline.h gives them
/// parts  loop_parts(loops) of libcore/mesh/loop_parts.h: the outer loop and the holes of each part
std::string outline_json(const std::vector<Loop>& loops, const std::vector<std::vector<std::size_t>>& parts,
                         const OutlineFacts& facts);

/// SVG: a black path for each part, with the rings of outline_json(), on a canvas of the image's size.
std::string outline_svg(const std::vector<Loop>& loops, const std::vector<std::vector<std::size_t>>& parts,
                        const OutlineFacts& facts);

}  // namespace imgmesh
