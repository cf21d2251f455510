// The connectivity in which edges collapse: every vertex keeps the cycle of its neighbours, nothing else.
//
// Faces and half-edges are implied: vertex i has the face (i, n[k], n[k+1]) for each consecutive pair. One
// record is one cache line, and a collapse splices two cycles.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "libcore/base/simd.h"
#include "libcore/base/types.h"
#include "libcore/mesh/grid_mesh.h"

namespace imgmesh {

/// A collapse may not make a vertex with more neighbours; only slivers would need more.
inline constexpr int kMaxValence = 12;

/// The coordinates that a vertex on the rectangle's border must keep: bits of Ring::fixed. A corner has both,
/// and so has a pixel of GridMesh::side_vertices.
enum FixedAxis : std::uint8_t { kFixedX = 1, kFixedY = 2 };

/// One vertex: 64 bytes.
struct alignas(64) Ring {
    float x = 0, y = 0;         ///< position [pixels]
    Id neighbor[kMaxValence];   ///< counter-clockwise on screen; on the border from the one along the border
                                ///< to the other, with no face between last and first
    std::uint8_t valence = 0;   ///< 0 if the vertex is removed
    std::uint8_t fixed = 0;     ///< FixedAxis bits; nonzero exactly for border vertices
    std::uint16_t version = 0;  ///< rises whenever the vertex merges or is removed
    std::uint8_t locked = 0;    ///< nonzero: must stay unchanged for now, with its edges (tile_collapser.h)

    bool border() const { return fixed != 0; }
    bool live() const { return valence != 0; }
    /// Returns the place of `other` among the neighbours, or -1.
    int find(Id other) const {
        const unsigned found = match12(neighbor, other) & ((1u << valence) - 1);
        return found != 0 ? std::countr_zero(found) : -1;
    }
};
static_assert(sizeof(Ring) == 64);

using RingMesh = std::vector<Ring>;

/// Returns the ring of vertex (x, y) of a grid mesh without a mask, with the same vertex ids.
Ring grid_ring(const GridMesh& grid, int x, int y);
/// The same for a vertex on no side, where that vertex is `self` and the one below is self + stride.
inline Ring inner_ring(const GridMesh& grid, int x, int y, Id self, Id stride) {
    Ring ring;
    ring.x = grid.origin_x + static_cast<float>(x);
    ring.y = grid.origin_y + static_cast<float>(y);
    int valence = 0;
    // Diagonals are written wherever there might be one, and overwritten where there is none.
    const auto push = [&](Id v, bool there) {
        ring.neighbor[valence] = v;
        valence += there;
    };
    push(self + 1, true);
    push(self - stride + 1, !grid.falling_diagonal(x, y - 1));
    push(self - stride, true);
    push(self - stride - 1, grid.falling_diagonal(x - 1, y - 1));
    push(self - 1, true);
    push(self + stride - 1, !grid.falling_diagonal(x - 1, y));
    push(self + stride, true);
    push(self + stride + 1, grid.falling_diagonal(x, y));
    ring.valence = static_cast<std::uint8_t>(valence);
    return ring;
}
/// Returns the rings of all vertices of a grid mesh.
RingMesh ring_mesh(const GridMesh& grid);

std::int64_t face_count(const RingMesh& rings);

/// Neighbours of the vertex that would replace the edge (i, j), in the order of Ring::neighbor.
struct MergedRing {
    std::array<Id, 2 * kMaxValence> neighbor;
    int valence = 0;
    int faces_removed = 0;  ///< 2, or 1 for a border edge
};

/// Computes the ring after merging j into i. Returns false if the topology forbids it. It allows the merge if
/// the two share no neighbours except the corners of the faces at the edge (link condition), the valence
/// stays within kMaxValence, and the edge is not an interior edge between two border vertices.
bool merge_rings(const RingMesh& rings, Id i, Id j, MergedRing& merged);

/// Carries out a merge: i gets `merged` as its ring, j is removed, and every neighbour's ring is updated.
void apply_merge(RingMesh& rings, Id i, Id j, const MergedRing& merged);

/// Returns the vertices that are not removed, ascending.
std::vector<Id> live_list(const RingMesh& rings);

/// Returns every face once, starting at its corner of the lowest number. Vertices are numbered by their place
/// in `order`, which lists all that are not removed.
std::vector<Face> ring_faces(const RingMesh& rings, const std::vector<Id>& order);

}  // namespace imgmesh
