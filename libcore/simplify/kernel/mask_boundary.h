// Decides how the boundary of a masked image may change: it covers the mask, and stays close to it.
#pragma once

#include <array>
#include <vector>

#include "libcore/mesh/grid_mesh.h"
#include "libcore/mesh/ring_mesh.h"
#include "libcore/mesh/tile_sides.h"

namespace imgmesh {

/// No point of a simplified boundary is farther from the dense one than this, nor the other way round [px].
/// The pixels of a straight line are less than one pixel from a line that covers them, so stairs of any slope
/// become straight; with 0.75 the flat ones stay, and a disc of 300 pixels keeps 116 boundary vertices
/// instead of 76 (docs/decisions/0005-masked-images.md).
inline constexpr float kBoundaryBand = 1.0f;

/// Two neighbours on a boundary may merge where
/// - the mesh only grows (a progressive hull), so that it always covers every pixel inside;
/// - the part of the dense boundary that the new edges stand for stays within kBoundaryBand of them;
/// - what is added touches no other edge of a boundary, so that parts of the mesh never overlap;
/// - nothing leaves the image.
/// All of it is decided exactly, on the kPositionStep grid. Vertices on a boundary are named i and j as in
/// merge_rings(); `rings` is the mesh before the merge.
class MaskBoundary {
  public:
    /// rings   of a mesh whose boundary is still the dense mesh's
    /// number  of each of its vertices in the grid mesh; empty where it is the same
    MaskBoundary(const GridMesh& grid, const RingMesh& rings, const std::vector<Id>& number);

    /// Places where the merged vertex would make the mesh only grow: at either end, where the outer
    /// neighbours' edges meet, at (x, y), and on a straight side as near to (x, y) as it goes. Snapped.
    struct Places {
        std::array<Vec2f, 7> at;
        int count = 0;
    };
    Places places(const RingMesh& rings, Id i, Id j, float x, float y) const;

    /// Returns whether (x, y), one of places(), is within the band and collides with nothing.
    bool allows(const RingMesh& rings, Id i, Id j, float x, float y);

    /// Whether a place is on a side of the image.
    bool on_side(const Vec2f& place) const {
        return imgmesh::on_side(place, grid_.feature.width, grid_.feature.height);
    }

    /// Must be called for every merge of j into i at (x, y), also of vertices on no boundary.
    void merge(const RingMesh& rings, Id i, Id j, float x, float y);

  private:
    struct Sides {
        Id a, b, c, d;  ///< along the boundary, inside on the left; b and c are i and j
    };
    static Sides sides(const RingMesh& rings, Id i, Id j);
    /// The points of the dense boundary from the one of `a` to that of `d`, as indices into points_.
    void collect_chain(const Sides& s);
    std::size_t nearest_in_chain(float x, float y) const;
    bool within_band(const RingMesh& rings, const Sides& s, const Vec2f& m) const;
    bool collides(const RingMesh& rings, const Sides& s, const Vec2f& m);

    /// A vertex of the dense boundary.
    struct Point {
        Vec2f position;
        Id pixel;
        Id next;       ///< the point after it on the boundary
        Id owner;      ///< of the current edge that stands for it: the point that its first end has taken
        Id vertex;     ///< whose place among the points this is, if it still lives
        Id anchor;     ///< the point of the dense boundary that this vertex stands for
        Id looked_at;  ///< number of the latest search that saw it
    };
    const GridMesh& grid_;
    std::vector<Point> points_;
    std::vector<Id> first_point_;  ///< of the dense mesh's vertices; kNone inside
    std::vector<Id> point_;        ///< of the current mesh's vertices
    std::vector<Id> chain_;
    Id searches_ = 0;
};

}  // namespace imgmesh
