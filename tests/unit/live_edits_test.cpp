// Edits that are solved again and again, and on meshes whose vertices and faces stand in another order.
#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "libcore/mesh/trivial_map.h"
#include "libcore/warp/displacement.h"
#include "libcore/warp/live_edits.h"
#include "tests/support/warp_samples.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

constexpr int kSide = 33;

// A square of 9 x 9 vertices, each a little off its place on the grid.
MeshImage square() {
    MeshImage m;
    m.source.width = m.source.height = kSide;
    m.levels.resize(1);
    BaseMesh& mesh = m.levels[0].mesh;
    for (Id y = 0; y < 9; ++y)
        for (Id x = 0; x < 9; ++x) {
            const bool inside = x > 0 && x < 8 && y > 0 && y < 8;
            const float off = inside ? 0.25f * static_cast<float>((3 * x + 5 * y) % 7) : 0.0f;
            mesh.position.emplace_back(4.0f * static_cast<float>(x) + off,
                                       4.0f * static_cast<float>(y) - off);
        }
    for (Id y = 0; y < 8; ++y)
        for (Id x = 0; x < 8; ++x) {
            const Id a = 9 * y + x, b = a + 1, c = a + 9, d = a + 10;
            mesh.faces.push_back({a, c, d});
            mesh.faces.push_back({a, d, b});
        }
    mesh.feature.assign(3 * mesh.vertex_count(), 0.5f);
    m.levels[0].map = trivial_map(mesh, kSide, kSide);
    return m;
}

// The same mesh, as a container may hold it: other numbers, other corners first. rank: of the vertices.
MeshImage shuffled(const MeshImage& from, std::vector<Id>& rank) {
    std::mt19937 random(5);
    MeshImage m = from;
    BaseMesh& mesh = m.levels[0].mesh;
    rank.resize(mesh.vertex_count());
    std::iota(rank.begin(), rank.end(), Id{0});
    std::shuffle(rank.begin(), rank.end(), random);
    for (Id v = 0; v < rank.size(); ++v) mesh.position[rank[v]] = from.levels[0].mesh.position[v];
    std::vector<Id> place(mesh.faces.size());
    std::iota(place.begin(), place.end(), Id{0});
    std::shuffle(place.begin(), place.end(), random);
    std::vector<std::size_t> turn(place.size());
    for (std::size_t f = 0; f < place.size(); ++f) {
        turn[f] = random() % 3;
        const Face& face = from.levels[0].mesh.faces[f];
        for (std::size_t k = 0; k < 3; ++k) mesh.faces[place[f]][k] = rank[face[(k + turn[f]) % 3]];
    }
    for (PixelCoord& c : m.levels[0].map.values) {
        const std::array<float, 3> w = {1 - c.u - c.v, c.u, c.v};
        const std::size_t t = turn[c.face];
        c = {place[c.face], w[(1 + t) % 3], w[(2 + t) % 3]};
    }
    return m;
}

WarpEdits pulled(const Vec2d& move, WarpSolver solver) {
    WarpEdit edit;
    edit.solver = solver;
    edit.handles.resize(2);
    edit.handles[0].vertices.near = Vec2d(16, 16);
    edit.handles[0].move = move;
    edit.handles[1].vertices.box = {{22, 5, 29, 11}};
    edit.handles[1].rotate_deg = 14;
    edit.pins.resize(1);
    edit.pins[0].border = true;
    return {edit};
}

}  // namespace

TEST_CASE("solve_edits: the order of vertices, faces and corners changes no bit") {
    const MeshImage m = square();
    std::vector<Id> rank;
    const MeshImage other = shuffled(m, rank);
    for (const WarpSolver solver : {WarpSolver::kDirect, WarpSolver::kArap, WarpSolver::kInjective}) {
        const EditSolution here = edit_solution(m, pulled({3.3, -1.7}, solver)),
                           there = edit_solution(other, pulled({3.3, -1.7}, solver));
        for (Id v = 0; v < rank.size(); ++v) CHECK(here.moves[0][v] == there.moves[0][rank[v]]);
        CHECK(edit_field(m, here).move == edit_field(other, there).move);
    }
}

TEST_CASE("LiveEdits: what was solved before changes no bit; a drag comes to the same place") {
    const MeshImage m = square();
    LiveEdits live(m);
    for (const WarpSolver solver : {WarpSolver::kArap, WarpSolver::kInjective}) {
        const WarpEdits last = pulled({3, 2}, solver);
        const auto expected = solve_edits(m, last);
        for (int step = 0; step <= 6; ++step) live.follow(pulled({0.5 * step, step / 3.0}, solver));
        EditSolution near = live.follow(last);
        for (int again = 0; again < 40; ++again) near = live.follow(last);
        double farthest = 0;
        for (std::size_t v = 0; v < expected[0].size(); ++v)
            farthest = std::max(farthest, double((near.moves[0][v] - expected[0][v]).norm()));
        CHECK(farthest < 0.1);
        CHECK(live.solve(last).moves == expected);
        // Twice the same edit is solved twice.
        WarpEdits twice = last;
        twice.push_back(last[0]);
        CHECK(live.solve(twice).moves == solve_edits(m, twice));
        CHECK(live.solve(last).moves == expected);
    }
    CHECK(live.solve({}).moves[0].empty());
}
