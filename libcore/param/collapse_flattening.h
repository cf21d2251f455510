// How a collapse carries points of the old triangles around its edge to the new ones (paper sec. 3.3, fig.
// 3).
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

/// The flat layouts of one collapse. An edge (i, j) whose ends merge at m, a point between them as a rule:
///
/// 1. the region shared by both stars, laid out around m, is cut anew into a fan of m;
/// 2. each star, now disjoint with m in the place of the other end, laid out around its own end, is cut anew
///    into a fan of m, without the end.
///
/// Where m lies on one of the ends, its star keeps its triangles, and step 2 of the other star does
/// everything.
///
/// Where m is not inside the shared region, as in one collapse of twenty of a busy image, and always where
/// only one end is on a border, no layout around m has the shared region. Instead of step 1 one end then
/// moves to m: its star is laid out around m and cut anew from a fan of the end into a fan of m. Step 2 of
/// the other star follows.
class CollapseFlattening {
  public:
    /// Lays out what is needed. Returns false where a layout does not exist or one of its two triangulations
    /// is not positively oriented (FlatFan): the collapse must not happen.
    ///
    /// stars   of both ends, before the collapse
    /// points  of all vertices, `dimensions` floats each: position [pixels], then weighted features
    /// merged  the new vertex, likewise
    /// shared  whether any point of the shared region will be asked for
    bool lay_out(const std::array<const OneRing*, 2>& stars, const float* points, const float* merged,
                 int dimensions, bool shared);

    /// Whether the star stays as it is, but for its faces that go.
    bool rests(int star) const { return mode_ == Mode::kOneEnd && star == pivot_; }
    /// Where a point of an old triangle goes: a face of the star that survives, with the weights of the
    /// merged vertex and of the other two. Not for points of the rest of a star that rests(), nor for its
    /// center.
    StarPoint carry(StarPoint point) const;
    /// Whether the face is one of the two, or the one, that both stars have.
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
    std::array<int, 2> other_{};  // where each star's ring has the other end
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
