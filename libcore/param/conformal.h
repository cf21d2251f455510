// The flattening of a vertex's ring by z^alpha (paper sec. 3.3; MAPS, Lee et al. 1998).
#pragma once

#include <array>
#include <span>

#include "libcore/mesh/ring_mesh.h"

namespace imgmesh {

/// The largest number of vertices in the ring of a collapse.
inline constexpr std::size_t kMaxFlatRing = kMaxValence;

/// The places of a ring's vertices with its pivot at the origin, counter-clockwise (x right, y *up*).
struct FlatRing {
    std::array<Vec2d, kMaxFlatRing> at;
    double exponent = 1;  ///< alpha
    double mean = 1;      ///< of the distances to the pivot; one such distance has length 1
};

/// Lays the ring of a pivot out flat. Angles at the pivot are scaled by alpha so that they fill 2 pi, or pi
/// if the ring is open (then the pivot is on a border, which becomes exactly the axis y = 0). A distance r
/// becomes (r / mean)^alpha. Angles and distances are those of points in `dimensions` dimensions, by inner
/// products.
///
/// ring   counter-clockwise, at most kMaxFlatRing points; an open one starts on the border at the angle 0
/// return false if a ring point coincides with the pivot or all angles are 0: no layout exists
bool flatten_ring(const float* pivot, std::span<const float* const> ring, int dimensions, bool open,
                  FlatRing& flat);

/// A point of a fan (center, ring[k], ring[k + 1]): its triangle and its weights, which sum to 1.
struct FanPoint {
    int triangle = 0;
    std::array<double, 3> weight{};  ///< of the center, of ring[triangle] and of the next one
};

/// A fan of triangles in the plane that locates points.
class FlatFan {
  public:
    /// Takes the triangles (center, ring[k], ring[k + 1]) of an open ring, and for a closed one also the
    /// last. Returns false if a triangle is not positively oriented or nearly degenerate: 2 area <=
    /// kLeastFlatness longest^2. At most kMaxFlatRing ring points.
    bool set(const Vec2d& center, std::span<const Vec2d> ring, bool closed);
    /// Returns the triangle nearest to p, with weights clamped to it. The fan has a triangle.
    FanPoint locate(const Vec2d& p) const;
    int size() const { return size_; }

    /// Locating points in thinner triangles is not stable. Larger values reject more collapses and make the
    /// map worse (docs/decisions/0007-tracked-map.md).
    static constexpr double kLeastFlatness = 1e-6;

  private:
    struct Triangle {
        double rx, ry, sx, sy;  // ring points minus the center
        double inverse;         // 1 / (2 area)
    };
    Vec2d center_ = Vec2d::Zero();
    std::array<Triangle, kMaxFlatRing> triangles_;
    int size_ = 0;
};

}  // namespace imgmesh
