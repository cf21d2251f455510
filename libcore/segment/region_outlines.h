// The borders of regions as lines that neighbours share.
#pragma once

#include <vector>

#include "libcore/segment/labels.h"

namespace imgmesh {

/// One step of a line: straight, or a parabola (a quadratic Bezier curve) if it has a control point.
struct OutlineStep {
    bool curve = false;
    Vec2d control = Vec2d::Zero();  ///< of a curve
    Vec2d end = Vec2d::Zero();
};

/// A line between the same two regions, from a point where three or more meet to the next, or back to its
/// start. Points are in pixels from the image's top-left corner.
struct OutlineArc {
    Id left = kNone;  ///< region on the left on screen; kNone outside
    Id right = kNone;
    Vec2d start = Vec2d::Zero();
    std::vector<OutlineStep> steps;
};

/// An arc in one direction.
struct DirectedArc {
    std::size_t arc = 0;
    bool reversed = false;
};
using OutlineRing = std::vector<DirectedArc>;  ///< closed, the region on its left

struct RegionOutlines {
    GridSize size;
    std::vector<OutlineArc> arcs;
    std::vector<std::vector<OutlineRing>> rings;  ///< of each region: around it and around its holes
};

/// How far a border may move from the pixels' edges, at most [pixels].
inline constexpr double kMostOutlineTolerance = 0.5;

/// Returns the borders of all regions. With tolerance 0 they run along pixels' edges. With more, stairs
/// become straight lines and curves with as few points as possible. Borders stay where the image ends, do not
/// cross, and every pixel's centre stays in its region. Points where regions meet stay too.
///
/// tolerance  0 to kMostOutlineTolerance [pixels]; how far a border may pass from the middle of a pixel edge
/// Throws Error(kBadArgument) for a tolerance out of range. Takes O(pixels + border * longest straight piece)
/// time; pieces are at most 256 pixels long.
RegionOutlines region_outlines(const LabelImage& labels, double tolerance);

}  // namespace imgmesh
