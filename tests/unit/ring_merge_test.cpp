#include <doctest/doctest.h>

#include <random>

#include "tests/support/grid_faces.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

using Edge = std::pair<Id, Id>;

std::vector<Face> faces_of(const RingMesh& rings) {
    const std::vector<Id> live = live_list(rings);
    std::vector<Face> faces = ring_faces(rings, live);
    for (Face& face : faces)
        for (Id& v : face) v = live[v];
    return faces;
}

// A triangulated disc whose rings say what its faces say.
void check_disc(const RingMesh& rings) {
    const std::vector<Face> faces = faces_of(rings);
    std::set<Edge> half_edges;
    std::set<Edge> edges;
    for (const Face& f : faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const Id a = f[k], b = f[(k + 1) % 3];
            CHECK(half_edges.insert({a, b}).second);  // twice: three faces at an edge, or one turned over
            edges.insert(std::minmax(a, b));
        }
    std::int64_t live = 0;
    for (Id v = 0; v < rings.size(); ++v) {
        if (!rings[v].live()) continue;
        ++live;
        bool border = false;
        CHECK(neighbors_of(rings[v]) == ring_of(faces, v, border));
        CHECK(border == rings[v].border());
    }
    CHECK(live - static_cast<std::int64_t>(edges.size()) + static_cast<std::int64_t>(faces.size()) == 1);
}

// The rule as the header states it, from faces alone.
bool may_merge(const std::vector<Face>& faces, const RingMesh& rings, Id i, Id j) {
    std::set<Id> around_i, around_j;
    int at_edge = 0;
    for (const Face& f : faces) {
        const bool has_i = std::find(f.begin(), f.end(), i) != f.end(),
                   has_j = std::find(f.begin(), f.end(), j) != f.end();
        at_edge += has_i && has_j;
        if (has_i) around_i.insert(f.begin(), f.end());
        if (has_j) around_j.insert(f.begin(), f.end());
    }
    std::set<Id> all = around_i;
    all.insert(around_j.begin(), around_j.end());
    const std::size_t ring = all.size() - 2, common = around_i.size() + around_j.size() - all.size() - 2;
    return common == static_cast<std::size_t>(at_edge) &&
           !(rings[i].border() && rings[j].border() && at_edge == 2) && ring >= 2 &&
           ring <= static_cast<std::size_t>(kMaxValence);
}

// Merges random edges until none is possible.
void merge_all(RingMesh rings, std::uint32_t seed) {
    std::mt19937 random(seed);
    for (;;) {
        const std::vector<Face> faces = faces_of(rings);
        std::vector<Edge> legal;
        for (Id i = 0; i < rings.size(); ++i)
            for (int k = 0; k < rings[i].valence; ++k) {
                const Id j = rings[i].neighbor[k];
                MergedRing merged;
                const bool may = merge_rings(rings, i, j, merged);
                INFO("edge " << i << " " << j);
                CHECK(may == may_merge(faces, rings, i, j));
                if (may) legal.emplace_back(i, j);
            }
        if (legal.empty()) return;
        const auto [i, j] = legal[random() % legal.size()];
        MergedRing merged;
        REQUIRE(merge_rings(rings, i, j, merged));
        const auto version_i = rings[i].version, version_j = rings[j].version;
        apply_merge(rings, i, j, merged);
        CHECK_FALSE(rings[j].live());
        CHECK(rings[i].version != version_i);
        CHECK(rings[j].version != version_j);
        CHECK(faces_of(rings).size() + static_cast<std::size_t>(merged.faces_removed) == faces.size());
        check_disc(rings);
    }
}

bool merges(const RingMesh& rings, Id i, Id j) {
    MergedRing merged;
    const bool one = merge_rings(rings, i, j, merged), other = merge_rings(rings, j, i, merged);
    CHECK(one == other);
    return one;
}

// Two hubs 0 and 1 side by side; each has `spokes` neighbours, the other hub and two shared ones included.
RingMesh two_hubs(Id spokes) {
    // The rim: shared 2, then 0's own, then shared 3, then 1's own.
    std::vector<Id> rim_0{2}, rim_1{3};
    Id next = 4;
    for (Id k = 0; k < spokes - 3; ++k) rim_0.push_back(next++);
    for (Id k = 0; k < spokes - 3; ++k) rim_1.push_back(next++);
    rim_0.push_back(3);
    rim_1.push_back(2);
    std::vector<Face> faces{{0, 3, 1}, {0, 1, 2}};
    for (std::size_t k = 0; k + 1 < rim_0.size(); ++k) faces.push_back({0, rim_0[k], rim_0[k + 1]});
    for (std::size_t k = 0; k + 1 < rim_1.size(); ++k) faces.push_back({1, rim_1[k], rim_1[k + 1]});
    return rings_of(faces, next);
}

}  // namespace

TEST_CASE("merges: a disc stays a disc, and exactly the legal merges are allowed") {
    for (const auto& [w, h] : {std::pair{2, 2}, {2, 5}, {3, 3}, {4, 3}, {5, 5}, {6, 4}})
        for (std::uint32_t seed = 1; seed <= 6; ++seed) {
            INFO(w << " x " << h << ", seed " << seed);
            merge_all(ring_mesh(grid_mesh(sample_feature(Kind::kNoise, w, h, seed))), seed);
        }
}

// An octahedron without its outermost face, with a vertex or without in its innermost one.
TEST_CASE("merges: three vertices joined around something stay three") {
    // Outer 0 1 2, inner 3 4 5.
    const std::vector<Face> between{{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    std::vector<Face> filled = between, divided = between;
    filled.push_back({3, 4, 5});
    divided.insert(divided.end(), {{3, 4, 6}, {4, 5, 6}, {5, 3, 6}});
    const RingMesh plain = rings_of(filled, 6), holding = rings_of(divided, 7);
    check_disc(plain);
    check_disc(holding);
    CHECK(merges(plain, 3, 4));
    CHECK_FALSE(merges(holding, 3, 4));  // 5, 6 and the outer one are neighbours of both
    CHECK(merges(holding, 3, 6));
}

TEST_CASE("merges: border vertices join along the border only") {
    // 0 1 2 / 3 4 5, all diagonals falling: the edge 1 4 crosses the inside, as does 0 4.
    GridMesh grid = grid_mesh(sample_feature(Kind::kConstant, 3, 2));
    const RingMesh rings = ring_mesh(grid);
    CHECK_FALSE(merges(rings, 1, 4));
    CHECK_FALSE(merges(rings, 0, 4));
    CHECK(merges(rings, 0, 1));
    CHECK(merges(rings, 4, 3));
    CHECK(merges(rings, 2, 5));

    MergedRing merged;
    REQUIRE(merge_rings(rings, 0, 1, merged));
    CHECK(merged.faces_removed == 1);
    CHECK(std::vector<Id>(merged.neighbor.begin(), merged.neighbor.begin() + merged.valence) ==
          std::vector<Id>{3, 4, 5, 2});
}

TEST_CASE("merges: an inner vertex joins the border, and the ring opens there") {
    const GridMesh grid = grid_mesh(sample_feature(Kind::kConstant, 3, 3));  // diagonals fall
    for (const bool into_border : {true, false}) {
        RingMesh rings = ring_mesh(grid);
        const Id i = into_border ? 1 : 4, j = into_border ? 4 : 1;
        MergedRing merged;
        REQUIRE(merge_rings(rings, i, j, merged));
        CHECK(merged.faces_removed == 2);
        CHECK(std::vector<Id>(merged.neighbor.begin(), merged.neighbor.begin() + merged.valence) ==
              std::vector<Id>{0, 3, 7, 8, 5, 2});
        apply_merge(rings, i, j, merged);
        CHECK(rings[i].fixed == kFixedY);
        check_disc(rings);
    }
}

TEST_CASE("merges: no vertex gets more than the largest valence") {
    const RingMesh fits = two_hubs(8), exceeds = two_hubs(9);
    check_disc(fits);
    CHECK(merges(fits, 0, 1));  // 8 + 8 - 4 = 12
    CHECK_FALSE(merges(exceeds, 0, 1));
}

TEST_CASE("merges: one triangle is the end") {
    const RingMesh rings = rings_of({{0, 1, 2}}, 3);
    check_disc(rings);
    CHECK_FALSE(merges(rings, 0, 1));
    CHECK_FALSE(merges(rings, 1, 2));
    CHECK_FALSE(merges(rings, 2, 0));
}
