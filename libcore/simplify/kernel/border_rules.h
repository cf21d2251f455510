// What the rectangle's border leaves free when two vertices merge.
#pragma once

#include "libcore/mesh/ring_mesh.h"

namespace imgmesh {

/// Where a merged vertex may go: its fixed coordinates, as FixedAxis bits, and their values.
struct BorderConstraint {
    bool allowed = false;    ///< false where the border forbids the merge altogether
    std::uint8_t fixed = 0;  ///< axes that are fixed
    float x = 0, y = 0;      ///< of use along fixed axes only
};

/// Whether a vertex, where all vertices of the sides are decided beforehand, is one that must go. Such a one
/// only merges along its side.
template <class Vertex>
inline bool must_go(const Vertex& v) {
    return v.fixed == kFixedX || v.fixed == kFixedY;
}

/// Corners stay, vertices of a side stay on their side.
template <class Vertex>
inline BorderConstraint border_constraint(const Vertex& a, const Vertex& b) {
    constexpr std::uint8_t kCorner = kFixedX | kFixedY;
    if ((a.fixed & b.fixed & kFixedX) && a.x != b.x) return {};
    if ((a.fixed & b.fixed & kFixedY) && a.y != b.y) return {};
    const auto fixed = static_cast<std::uint8_t>(a.fixed | b.fixed);
    if (fixed == kCorner && a.fixed != kCorner && b.fixed != kCorner) return {};
    return {true, fixed, a.fixed & kFixedX ? a.x : b.x, a.fixed & kFixedY ? a.y : b.y};
}

}  // namespace imgmesh
