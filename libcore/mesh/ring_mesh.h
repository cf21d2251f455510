// The connectivity that edges collapse in: every vertex keeps the cycle of its neighbours, nothing else.
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

/// A collapse may not make a vertex with more neighbours; more would only be needed by slivers.
inline constexpr int kMaxValence = 12;

/// What a vertex of the rectangle's border may not change: bits of Ring::fixed. A corner has both.
enum FixedAxis : std::uint8_t { kFixedX = 1, kFixedY = 2 };

/// One vertex: 64 bytes.
struct alignas(64) Ring {
    float x = 0, y = 0;         ///< position [pixels]
    Id neighbor[kMaxValence];   ///< counter-clockwise on screen; on the border from the one along the border
                                ///< to the other, with no face between last and first
    std::uint8_t valence = 0;   ///< 0: the vertex is removed
    std::uint8_t fixed = 0;     ///< FixedAxis bits; not 0 exactly for border vertices
    std::uint16_t version = 0;  ///< rises whenever the vertex merges or goes
    std::uint8_t locked = 0;    ///< not 0: must stay as it is for now, like its edges (edge_collapser.h)

    bool border() const { return fixed != 0; }
    bool live() const { return valence != 0; }
    /// The place of `other` among the neighbours, or -1.
    int find(Id other) const {
        const unsigned found = match12(neighbor, other) & ((1u << valence) - 1);
        return found != 0 ? std::countr_zero(found) : -1;
    }
};
static_assert(sizeof(Ring) == 64);

using RingMesh = std::vector<Ring>;

/// The ring of vertex (x, y) of a grid mesh without a mask, vertex ids as there.
Ring grid_ring(const GridMesh& grid, int x, int y);
/// The same for a vertex on no side, vertices numbered so that it is `self` and the one below self + stride.
inline Ring inner_ring(const GridMesh& grid, int x, int y, Id self, Id stride) {
    Ring ring;
    ring.x = grid.origin_x + static_cast<float>(x);
    ring.y = grid.origin_y + static_cast<float>(y);
    int valence = 0;
    // Diagonals are written wherever they might be, and written over where they are not.
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
/// The rings of all vertices of a grid mesh.
RingMesh ring_mesh(const GridMesh& grid);

std::int64_t face_count(const RingMesh& rings);

/// Neighbours of the vertex that would replace the edge (i, j), in the order of Ring::neighbor.
struct MergedRing {
    std::array<Id, 2 * kMaxValence> neighbor;
    int valence = 0;
    int faces_removed = 0;  ///< 2, or 1 for a border edge
};

/// The ring after merging j into i, where the topology allows it: the two share no neighbour but the corners
/// of the faces at the edge (link condition), the valence stays within kMaxValence, and no interior edge
/// joins two border vertices. Returns false otherwise.
bool merge_rings(const RingMesh& rings, Id i, Id j, MergedRing& merged);

/// Carries a merge out: i gets `merged` as its ring, j goes, and every neighbour's ring follows.
void apply_merge(RingMesh& rings, Id i, Id j, const MergedRing& merged);

/// The live vertices, ascending.
std::vector<Id> live_list(const RingMesh& rings);

/// Every face once, each from its corner of the lowest number; vertices are numbered as `order` lists them,
/// which has all the live ones.
std::vector<Face> ring_faces(const RingMesh& rings, const std::vector<Id>& order);

}  // namespace imgmesh
