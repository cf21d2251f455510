#include "libcore/mesh/ring_mesh.h"

#include <cassert>

#include "libcore/base/parallel.h"
#include "libcore/mesh/mask_fans.h"
#include "libcore/mesh/masked_rings.h"

namespace imgmesh {
namespace {

// Rows of one block: enough work to be worth handing over, few enough for every thread to get some.
constexpr int kGrainRows = 16;

}  // namespace

Ring grid_ring(const GridMesh& grid, int x, int y) {
    Ring ring;
    const int w = grid.feature.width, h = grid.feature.height;
    ring.x = grid.origin_x + static_cast<float>(x);
    ring.y = grid.origin_y + static_cast<float>(y);
    ring.fixed = static_cast<std::uint8_t>((x == 0 || x == w - 1 ? kFixedX : 0) |
                                           (y == 0 || y == h - 1 ? kFixedY : 0));
    if (ring.fixed != 0 && grid.keeps(as_id(grid.feature.index(x, y)))) ring.fixed = kFixedX | kFixedY;
    const auto inside = [&](PixelStep s) { return grid.feature.contains(x + s.dx, y + s.dy); };
    // Begin after the gap, so that a border vertex's open fan is in order.
    int first = 0;
    for (int k = 0; k < 8; k += 2)
        if (inside(kAround[k]) && !inside(kAround[(k + 6) % 8])) first = k;
    for (int n = 0; n < 8; ++n) {
        const PixelStep s = kAround[(first + n) % 8];
        if (!inside(s)) continue;
        if (s.dx != 0 && s.dy != 0) {
            const bool falling = s.dx == s.dy;  // this step runs along the falling diagonal of its cell
            if (grid.falling_diagonal(x + (s.dx < 0 ? -1 : 0), y + (s.dy < 0 ? -1 : 0)) != falling) continue;
        }
        ring.neighbor[ring.valence++] = as_id(grid.feature.index(x + s.dx, y + s.dy));
    }
    return ring;
}

RingMesh ring_mesh(const GridMesh& grid) {
    if (!grid.mask.empty()) return masked_rings(grid);
    RingMesh rings(grid.feature.pixel_count());
    parallel_blocks(0, grid.feature.height, kGrainRows, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < grid.feature.width; ++x)
                rings[grid.feature.index(x, y)] = grid_ring(grid, x, y);
    });
    return rings;
}

std::int64_t face_count(const RingMesh& rings) {
    std::int64_t corners = 0;
    for (const Ring& ring : rings)
        if (ring.live()) corners += ring.valence - (ring.border() ? 1 : 0);
    return corners / 3;
}

bool merge_rings(const RingMesh& rings, Id i, Id j, MergedRing& merged) {
    const Ring &a = rings[i], &b = rings[j];
    const int at_j = a.find(j), at_i = b.find(i);
    assert(at_j >= 0 && at_i >= 0);
    const int na = a.valence, nb = b.valence;
    int count = 0;
    int shared = 0;  // faces at the edge
    const auto push = [&](Id v) { merged.neighbor[as_index(count++)] = v; };

    // Collects the outer neighbours of j, in order, and how many of the edge's two faces exist.
    if (a.border() && b.border()) {
        // Legal only along the border, where one end is last in the other's fan.
        if (at_j == na - 1 && at_i == 0) {
            for (int k = 0; k < na - 1; ++k) push(a.neighbor[k]);
            for (int k = 2; k < nb; ++k) push(b.neighbor[k]);
        } else if (at_j == 0 && at_i == nb - 1) {
            for (int k = 0; k < nb - 2; ++k) push(b.neighbor[k]);
            for (int k = 1; k < na; ++k) push(a.neighbor[k]);
        } else {
            return false;
        }
        shared = 1;
    } else {
        // An interior edge: j's cycle is cut open after i's second face. If i is interior and j on the
        // border, j's fan replaces i's, which is the same ring read from the other side.
        const Ring &outer = b.border() ? b : a, &inner = b.border() ? a : b;
        const int at_inner = b.border() ? at_i : at_j, at_outer = b.border() ? at_j : at_i;
        for (int k = 0; k < at_inner; ++k) push(outer.neighbor[k]);
        // From the neighbour of outer after the predecessor of inner, round to the one before its successor.
        for (int k = 2; k < inner.valence - 1; ++k) push(inner.neighbor[(at_outer + k) % inner.valence]);
        for (int k = at_inner + 1; k < outer.valence; ++k) push(outer.neighbor[k]);
        shared = 2;
    }
    if (count > kMaxValence || count < 2) return false;
    merged.valence = count;
    merged.faces_removed = shared;

    // Link condition: the outer neighbours of j must not be neighbours of i already.
    int common = 0;
    for (int k = 0; k < nb; ++k) common += b.neighbor[k] != i && a.find(b.neighbor[k]) >= 0;
    return common == shared;
}

void apply_merge(RingMesh& rings, Id i, Id j, const MergedRing& merged) {
    const Ring removed = rings[j];
    Ring& ring = rings[i];
    for (int k = 0; k < removed.valence; ++k) {
        if (removed.neighbor[k] == i) continue;
        Ring& n = rings[removed.neighbor[k]];
        const int at_j = n.find(j);
        if (n.find(i) < 0) {
            n.neighbor[at_j] = i;
        } else {  // a corner of a face at the edge: j is removed from its ring
            for (int m = at_j; m + 1 < n.valence; ++m) n.neighbor[m] = n.neighbor[m + 1];
            --n.valence;
        }
    }
    for (int k = 0; k < merged.valence; ++k) ring.neighbor[k] = merged.neighbor[as_index(k)];
    ring.valence = static_cast<std::uint8_t>(merged.valence);
    ring.fixed |= removed.fixed;
    ++ring.version;
    rings[j].valence = 0;
    ++rings[j].version;
}

std::vector<Id> live_list(const RingMesh& rings) {
    std::vector<Id> live;
    for (Id v = 0; v < rings.size(); ++v)
        if (rings[v].live()) live.push_back(v);
    return live;
}

std::vector<Face> ring_faces(const RingMesh& rings, const std::vector<Id>& order) {
    std::vector<Id> number(rings.size(), kNone);
    for (Id n = 0; n < order.size(); ++n) number[order[n]] = n;
    std::vector<Face> faces;
    faces.reserve(order.size() * 2);
    for (Id a = 0; a < order.size(); ++a) {
        const Ring& ring = rings[order[a]];
        for (int k = 0; k < ring.valence; ++k) {
            if (ring.border() && k + 1 == ring.valence) break;  // the gap of an open fan
            const Id b = number[ring.neighbor[k]], c = number[ring.neighbor[(k + 1) % ring.valence]];
            if (a < b && a < c) faces.push_back({a, b, c});
        }
    }
    return faces;
}

}  // namespace imgmesh
