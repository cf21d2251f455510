// The rings of a tile while its edges collapse: neighbours by small numbers, and beside each what it costs to
// merge with it.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "libcore/mesh/ring_mesh.h"
#include "libcore/simplify/kernel/short_lanes.h"

namespace imgmesh {

/// The number of a vertex in its tile, below kNotInTile.
using TileId = std::uint16_t;
/// kNotInTile + k: not in the tile; the k-th neighbour of the ring that the tile's was made from. Only the
/// rings of locked vertices have such.
inline constexpr TileId kNotInTile = 0xff00;
inline constexpr TileId kNoTileId = 0xffff;

/// The upper half of a float >= 0, which keeps the order: 7 bits of the mantissa.
using ShortCost = std::uint16_t;
/// Of an edge that may not collapse for now.
inline constexpr ShortCost kShortNever = 0x7f80;
/// Behind a ring's last edge.
inline constexpr ShortCost kNoEdge = 0x7fff;
inline constexpr ShortCost short_cost(float cost) {
    return static_cast<ShortCost>(std::bit_cast<std::uint32_t>(cost) >> 16);
}
/// Of eight increments, of which those below 0 count as 0.
IMGMESH_INLINE void short_costs(const Float8& increments, ShortCost* out) {
    const Float8 added = increments > 0 ? increments : Float8{};
    const Short8 upper = __builtin_convertvector(std::bit_cast<Int8>(added) >> 16, Short8);
    __builtin_memcpy(out, &upper, sizeof upper);
}
/// The least float of that cost.
inline constexpr float least_cost(ShortCost cost) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(cost) << 16);
}

/// Neighbours in the order of Ring::neighbor, though inside the mesh from any of them on. One cache line.
struct alignas(64) TileRing {
    static constexpr int kRoom = 16;
    TileId neighbor[kRoom];  ///< kNoTileId behind the last
    ShortCost cost[kRoom];   ///< of the edge to it; kNoEdge behind the last

    /// Returns the place of a neighbour.
    IMGMESH_INLINE int find(TileId n) const { return std::countr_zero(match16(neighbor, n)); }
    /// Names i what was i or j, at the cost of the edge to i. Returns whether both were there: then the ring
    /// has a neighbour less.
    IMGMESH_INLINE bool merge(TileId i, TileId j, ShortCost edge) {
        const unsigned at = match16(neighbor, i, j);
        const int first = std::countr_zero(at);
        neighbor[first] = i;
        cost[first] = edge;
        const unsigned rest = at & (at - 1);
        if (rest == 0) return false;
        remove16(neighbor, std::countr_zero(rest));
        remove16(cost, std::countr_zero(rest));
        return true;
    }
};
static_assert(TileRing::kRoom > kMaxValence && sizeof(TileRing) == 64);

/// What else a vertex has; members as in Ring.
struct alignas(16) TileVertex {
    float x, y;
    std::uint8_t valence, fixed;
    bool locked;  ///< must stay unchanged, with its edges: a neighbour is elsewhere

    bool border() const { return fixed != 0; }
    bool live() const { return valence != 0; }
};

/// MergedRing in a tile; kNoTileId behind the last.
struct MergedTileRing {
    TileId neighbor[2 * TileRing::kRoom];
    int valence;
    int faces_removed;
};

namespace tile_rings {

// One end of an edge: its ring and the place of the other end in it.
struct End {
    const TileId* ring;
    int valence, at;
};

// Writes the neighbours of a vertex inside the mesh, beginning behind the other end.
IMGMESH_INLINE void write_cycle(const End& end, int behind, TileId* out) {
    // Written twice, one behind the other, so that it can be read from any place on.
    TileId twice[2 * TileRing::kRoom + 2];
    store16(twice, load16(end.ring));
    store16(twice + end.valence, load16(end.ring));
    store16(out, load16(twice + end.at + behind));
}

// Returns false where the edge does not lie along the border.
[[gnu::noinline]] inline bool merge_along_border(const End& a, const End& b, TileId* out) {
    if (a.at == a.valence - 1 && b.at == 0) {
        out = std::copy(a.ring, a.ring + a.valence - 1, out);
        std::copy(b.ring + 2, b.ring + b.valence, out);
    } else if (a.at == 0 && b.at == b.valence - 1) {
        out = std::copy(b.ring, b.ring + b.valence - 2, out);
        std::copy(a.ring + 1, a.ring + a.valence, out);
    } else {
        return false;
    }
    return true;
}

// `outer` is on the border, `inner` is not.
[[gnu::noinline]] inline void merge_to_border(const End& outer, const End& inner, TileId* out) {
    out = std::copy(outer.ring, outer.ring + outer.at, out);
    for (int k = 2; k < inner.valence - 1; ++k) *out++ = inner.ring[(inner.at + k) % inner.valence];
    std::copy(outer.ring + outer.at + 1, outer.ring + outer.valence, out);
}

}  // namespace tile_rings

/// merge_rings() for two vertices of a tile that are not locked: the same answer, and the same ring but for
/// where it begins inside the mesh.
IMGMESH_INLINE bool merge_rings(const std::vector<TileRing>& rings, const std::vector<TileVertex>& vertices,
                                TileId i, TileId j, MergedTileRing& merged) {
    const TileRing &a = rings[i], &b = rings[j];
    const bool border_i = vertices[i].border(), border_j = vertices[j].border();
    const int na = vertices[i].valence, nb = vertices[j].valence;
    const int shared = border_i && border_j ? 1 : 2;
    int common = 0;
    for (int k = 0; k < nb; ++k) common += match16(a.neighbor, b.neighbor[k]) != 0;
    merged.faces_removed = shared;
    merged.valence = na + nb - 2 - shared;
    if (common != shared || merged.valence > kMaxValence || merged.valence < 2) return false;
    const tile_rings::End end_i{a.neighbor, na, a.find(j)}, end_j{b.neighbor, nb, b.find(i)};
    if (!border_i && !border_j) {
        tile_rings::write_cycle(end_i, 1, merged.neighbor);
        tile_rings::write_cycle(end_j, 2, merged.neighbor + na - 1);
    } else if (border_i && border_j) {
        if (!tile_rings::merge_along_border(end_i, end_j, merged.neighbor)) return false;
    } else if (border_i) {
        tile_rings::merge_to_border(end_i, end_j, merged.neighbor);
    } else {
        tile_rings::merge_to_border(end_j, end_i, merged.neighbor);
    }
    fill16_from(merged.neighbor, merged.valence, kNoTileId);
    return true;
}

}  // namespace imgmesh
