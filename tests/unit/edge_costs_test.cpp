#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "libcore/simplify/kernel/edge_costs.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

// 8 x 7 pixels of noise: each vertex with all its neighbours at once, against edge by edge. Away from the
// border the batch gives the least growth of the error at any place, and a single edge that at a place of the
// grid that positions lie on, so it costs as much or a little more.
TEST_CASE("edge costs: all edges of a vertex at once cost what each costs alone") {
    const GridMesh grid = grid_mesh(sample_feature(Kind::kNoise, 8, 7));
    QuadricMesh<Quadric<3>> mesh;
    mesh.rings = ring_mesh(grid);
    const SimplifyParams params;
    mesh.quadrics = initial_quadrics<Quadric<3>>(grid, mesh.rings, FeaturePatch{grid.feature}, params);
    const SimplifyHooks hooks;
    const SimplifyRules rules{params, hooks, 3, {}};
    const EdgeCosts<Quadric<3>> edges(mesh, rules);
    int forbidden = 0, inner = 0;
    for (Id i = 0; i < mesh.rings.size(); ++i) {
        const Ring& ring = mesh.rings[i];
        Id others[kNeighborRoom];
        float increments[kNeighborRoom];
        std::copy_n(ring.neighbor, ring.valence, others);
        edges.increments(i, others, ring.valence, increments);
        for (int k = 0; k < ring.valence; ++k) {
            const float alone = edges.cost(i, ring.neighbor[k]);
            const float together = edges.cost(i, ring.neighbor[k], increments[k]);
            INFO(i << " - " << ring.neighbor[k] << ": " << together << ", " << alone);
            if (ring.border() || mesh.rings[ring.neighbor[k]].border()) {
                CHECK(together == alone);
                forbidden += alone == kNever;
            } else {
                CHECK(alone >= together * (1 - 1e-4f));
                CHECK(alone <= together * 1.05f + 0.01f);
                ++inner;
            }
        }
    }
    CHECK(forbidden > 0);  // edges from one side to another at the corners
    CHECK(inner > 0);
}

TEST_CASE("edge costs: the median") {
    CHECK(median({3}) == 3);
    CHECK(median({5, 1}) == 5);  // of two the upper one
    CHECK(median({9, 1, 4}) == 4);
    CHECK(median({4, 4, 1, std::numeric_limits<float>::infinity()}) == 4);
}
