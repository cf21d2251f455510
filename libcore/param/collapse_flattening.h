// How a collapse carries points of the old triangles around its edge to the new triangles (paper sec. 3.3,
// fig. 3).
#pragma once

#include <array>

#include "libcore/mesh/one_ring.h"
#include "libcore/param/conformal.h"

namespace imgmesh {

/// A point in the star of one of the two ends: star 0 is that of the kept end, star 1 that of the other.
struct StarPoint {
    int star = 0;
    FanPoint at;  ///< its triangle is a face of that star
};

/// The flat layouts of one collapse of an edge (i, j), whose ends merge at m. Usually m lies between
/// them:
///
/// 1. The region shared by both stars is laid out around m and cut anew into a fan of m.
/// 2. Each star, now disjoint with m in the place of the other end, is laid out around its own end and
///    cut anew into a fan of m, without the end.
///
/// If m is one of the ends, its star keeps its triangles, and step 2 of the other star does everything.
///
/// Sometimes no layout around m contains the shared region: if m is not inside it (one collapse in twenty
/// of a busy image), and always if only one end is on a border. Then, instead of step 1, one end moves to
/// m: its star is laid out around m and cut anew from a fan of the end into a fan of m. Step 2 of the
/// other star follows.
class CollapseFlattening {
  public:
    /// Makes the layouts that are needed. Returns false if a layout does not exist or one of its two
    /// triangulations is not positively oriented (FlatFan): the collapse must be rejected.
    ///
    /// stars   of both ends, before the collapse
    /// points  of all vertices, `dimensions` floats each: position [pixels], then weighted features
    /// merged  the new vertex, in the same form
    /// shared  whether points of the shared region will be carried
    bool lay_out(const std::array<const OneRing*, 2>& stars, const float* points, const float* merged,
                 int dimensions, bool shared);

    /// Returns whether the star stays unchanged, except for its removed faces.
    bool rests(int star) const { return mode_ == Mode::kOneEnd && star == pivot_; }
    /// Returns the new place of a point of an old triangle: a face of the star that stays, with the weights
    /// of the merged vertex and of the other two. Not for other points of a star that rests(), nor for its
    /// center.
    StarPoint carry(StarPoint point) const;
    /// Returns whether the face is one of those (two, or one) that both stars have.
    bool is_shared(int star, int face) const;

  private:
    enum class Mode {
        kBetween,  // steps 1 and 2
        kOneEnd,   // m is the end `pivot_`
        kMove      // the end `pivot_` moves first
    };
    bool in_shared_region(const float* points, const float* merged, int dimensions) const;
    bool lay_out_shared(const float* points, const float* merged, int dimensions);
    bool lay_out_move(const float* points, const float* merged, int dimensions);
    bool lay_out_star(int star, const float* points, const float* merged, int dimensions);
    FanPoint without_end(int star, const FanPoint& point) const;
    StarPoint in_other_star(const StarPoint& point) const;
    StarPoint across_shared(const StarPoint& point) const;
    FanPoint moved(const FanPoint& point) const;

    std::array<const OneRing*, 2> stars_{};
    std::array<int, 2> other_{};  // the place of the other end in each star's ring
    Mode mode_ = Mode::kBetween;
    int pivot_ = 0;
    FlatRing shared_ring_;  // around m: j, a, i, b; at the border j, a, i or i, a, j
    FlatFan shared_fan_;
    FlatRing move_ring_;  // around m
    Vec2d move_end_ = Vec2d::Zero();
    FlatFan move_fan_;
    std::array<FlatRing, 2> star_ring_;  // around the end, with m for the other end
    std::array<FlatFan, 2> star_fan_;    // of m, from the ring vertex after it on
};

}  // namespace imgmesh
