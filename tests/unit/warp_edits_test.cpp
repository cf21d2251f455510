// From edits to moved vertices and pixels.
#include <doctest/doctest.h>

#include <cmath>

#include "libcore/base/error.h"
#include "libcore/warp/arap.h"
#include "libcore/warp/solve_edits.h"
#include "libcore/warp/warp_image.h"
#include "libcore/warp/warp_mesh.h"
#include "tests/support/warp_samples.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

WarpEdit move_near(const Vec2d& point, const Vec2d& move, int level = 0,
                   WarpSolver solver = WarpSolver::kDirect) {
    WarpHandle handle;
    handle.vertices.near = point;
    handle.move = move;
    WarpEdit edit;
    edit.level = level;
    edit.solver = solver;
    edit.handles = {handle};
    return edit;
}

std::string refusal(const MeshImage& m, const WarpEdits& edits) {
    try {
        solve_edits(m, edits);
    } catch (const Error& e) {
        CHECK(e.kind() == ErrorKind::kBadFile);
        return e.what();
    }
    return "";
}

Vec2d turned(const Vec2d& p, const Vec2d& center, double angle_deg) {
    const double a = angle_deg * M_PI / 180;
    const Vec2d d = p - center;
    return center +
           Vec2d(std::cos(a) * d.x() + std::sin(a) * d.y(), std::cos(a) * d.y() - std::sin(a) * d.x());
}

}  // namespace

TEST_CASE("solve_edits: a handle scales, turns, then moves its vertices") {
    MeshImage m;
    m.levels.resize(1);
    m.levels[0].mesh.position = {{10, 10}, {14, 10}, {12, 4}};
    m.levels[0].mesh.faces = {{0, 1, 2}};
    WarpHandle handle;
    handle.vertices.vertices = {0, 1};
    handle.scale = {2, 1};
    handle.rotate_deg = 90;
    handle.move = {1, 0};
    const auto moves = solve_edits(m, {{0, WarpSolver::kDirect, {handle}, {}, ""}});
    // About (12, 10): (-2, 0) becomes (-4, 0), counter-clockwise on screen (0, 4), below as y grows down.
    CHECK((moves[0][0] - Vec2f(3, 4)).norm() < 1e-5f);
    CHECK((moves[0][1] - Vec2f(-1, -4)).norm() < 1e-5f);
    CHECK(moves[0][2] == Vec2f(0, 0));
    handle.center = Vec2d(10, 10);
    handle.vertices = {};
    handle.vertices.circle = {14, 9, 1.5};
    const auto one = solve_edits(m, {{0, WarpSolver::kDirect, {handle}, {}, ""}});
    CHECK((one[0][1] - Vec2f(10 - 14 + 1, -8)).norm() < 1e-5f);
    CHECK(one[0][0] == Vec2f(0, 0));
    handle.vertices = {};
    handle.vertices.beyond = {14, 9, 1.5};
    const auto others = solve_edits(m, {{0, WarpSolver::kDirect, {handle}, {}, ""}});
    CHECK(others[0][0] == Vec2f(1, 0));
    CHECK((others[0][2] - Vec2f(10 - 6 - 12 + 1, 10 - 4 - 4)).norm() < 1e-5f);
    CHECK(others[0][1] == Vec2f(0, 0));
}

// A tip of a sprite lies on its border, and is pulled while the rest of the border stays.
TEST_CASE("solve_edits: a border is pinned where no handle moves it") {
    const MeshImage m = grid_pyramid(9, 9, {3});
    WarpEdit edit = move_near({0, 0}, {-1, -2}, 0);
    edit.solver = WarpSolver::kArap;
    edit.pins.resize(1);
    edit.pins[0].border = true;
    const VertexMoves moves = solve_edits(m, {edit})[0];
    for (Id v = 0; v < moves.size(); ++v) {
        const Vec2f& p = m.levels[0].mesh.position[v];
        if (p == Vec2f(0, 0))
            CHECK(moves[v] == Vec2f(-1, -2));
        else if (p.minCoeff() == 0 || p.maxCoeff() == 8)
            CHECK(moves[v] == Vec2f(0, 0));
        else
            CHECK(moves[v] != Vec2f(0, 0));
    }
}

TEST_CASE("solve_edits: what is not there is refused, by its place") {
    const MeshImage m = grid_pyramid(9, 9, {3, 1});
    WarpEdit edit = move_near({0, 0}, {1, 1}, 2);
    edit.where = "e.json: /edits/0/level";
    CHECK(refusal(m, {edit}) ==
          "e.json: /edits/0/level: level 2 is not there; the container has levels 0 to 1");
    edit.level = 1;
    edit.handles[0].vertices = {};
    edit.handles[0].vertices.vertices = {3, 4};
    edit.handles[0].vertices.where = "e.json: /edits/0/handles/0/vertices";
    CHECK(refusal(m, {edit}) ==
          "e.json: /edits/0/handles/0/vertices: vertex 4 is not there; level 1 has vertices 0 to 3");
    edit.handles[0].vertices.vertices = {3};
    edit.pins.resize(1);
    edit.pins[0].vertices = {0, 3};
    edit.pins[0].where = "e.json: /edits/0/pins/0/vertices";
    CHECK(refusal(m, {edit}) ==
          "e.json: /edits/0/pins/0/vertices: vertex 3 is also in a handle of this edit");
    edit.pins[0] = {};
    edit.pins[0].box = {2, 2, 3, 3};
    edit.pins[0].where = "e.json: /edits/0/pins/0/box";
    CHECK(refusal(m, {edit}) == "e.json: /edits/0/pins/0/box: no vertex of level 1 lies there");
}

// The paper's claim: motions are smooth and local.
TEST_CASE("displacement_field: a vertex moves its one-ring, smoothly, and nothing else") {
    const MeshImage m = grid_pyramid(60, 50, {4});
    const BaseMesh& mesh = m.levels[0].mesh;
    const Vec2d move(5, -3);
    const auto moves = solve_edits(m, {move_near({30, 25}, move)});
    const DisplacementField field = displacement_field(m, moves);
    // The fastest change of a weight: 1 / the least height of a triangle of the ring.
    double steepest = 0;
    Id handle = 0;
    while (moves[0][handle].isZero()) ++handle;
    for (const auto& [a, b, c] : mesh.faces)
        for (const auto& [v, p, q] : {std::array{a, b, c}, std::array{b, c, a}, std::array{c, a, b}})
            if (v == handle)
                steepest = std::max(steepest,
                                    double((mesh.position[p] - mesh.position[q]).norm()) /
                                        signed_area2(mesh.position[v], mesh.position[p], mesh.position[q]));
    int moved = 0;
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 60; ++x) {
            const PixelCoord& c = m.levels[0].map.row(y)[static_cast<std::size_t>(x)];
            const Face& face = mesh.faces[c.face];
            const Vec2f here = field.move[field.index(x, y)];
            if (std::find(face.begin(), face.end(), handle) == face.end())
                CHECK(here == Vec2f(0, 0));
            else
                ++moved;
            if (x == 0) continue;
            const double step = (here - field.move[field.index(x - 1, y)]).cast<double>().norm();
            CHECK(step <= move.norm() * steepest + 1e-5);
        }
    CHECK(moved > 100);
    // The handle's own pixel moves the whole way.
    float most = 0;
    for (const Vec2f& d : field.move) most = std::max(most, d.norm());
    CHECK(most > 0.9 * move.norm());
}

TEST_CASE("displacement_field: edits of several levels add up") {
    const MeshImage m = grid_pyramid(40, 40, {8, 3, 1});
    const WarpEdits edits = {move_near({20, 20}, {2, 1}), move_near({10, 30}, {-3, 2}, 1),
                             move_near({0, 0}, {4, 4}, 2, WarpSolver::kArap), move_near({21, 20}, {1, 0})};
    const DisplacementField all = displacement_field(m, solve_edits(m, edits));
    std::vector<Vec2f> sum(all.move.size(), Vec2f(0, 0));
    for (const WarpEdit& edit : edits) {
        const DisplacementField one = displacement_field(m, solve_edits(m, {edit}));
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += one.move[i];
    }
    double worst = 0;
    for (std::size_t i = 0; i < sum.size(); ++i)
        worst = std::max(worst, double((sum[i] - all.move[i]).norm()));
    CHECK(worst < 1e-5);
}

// A ring: the hole keeps a pull on one side away from the other.
TEST_CASE("warp_image: pulling one side of an annulus leaves the far side untouched") {
    MeshImage m = grid_pyramid(64, 64, {6});
    const auto radius = [](int x, int y) { return std::hypot(x - 31.5, y - 31.5); };
    apply_mask(m, [&](int x, int y) { return radius(x, y) < 30 && radius(x, y) > 17; });
    const Image image = noise_image(64, 64, 3);
    const Image still = warp_image(image, displacement_field(m, solve_edits(m, {})));
    const Image pulled =
        warp_image(image, displacement_field(m, solve_edits(m, {move_near({58, 32}, {8, 0})})));
    int same = 0, differ = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            if (still.pixel(x, y)[3] == 0) continue;
            const bool equal = std::equal(still.pixel(x, y), still.pixel(x, y) + 4, pulled.pixel(x, y));
            if (x < 32) CHECK(equal);
            same += equal;
            differ += !equal;
        }
    CHECK(same > 700);
    CHECK(differ > 50);
}

TEST_CASE("solve_edits: every vertex moved by whole numbers moves every pixel so") {
    const MeshImage m = grid_pyramid(33, 21, {4});
    for (const WarpSolver solver : {WarpSolver::kDirect, WarpSolver::kArap, WarpSolver::kInjective}) {
        WarpEdit edit = move_near({0, 0}, {7, -5}, 0, solver);
        edit.handles[0].vertices = {};
        edit.handles[0].vertices.box = {0, 0, 32, 20};
        for (const Vec2f& d : displacement_field(m, solve_edits(m, {edit})).move) CHECK(d == Vec2f(7, -5));
    }
}

// Each alone folds nothing, but their sum would: both push the same vertices, and the second pin is pushed
// away.
TEST_CASE("edit_solution: injective edits of a level are one") {
    const MeshImage m = grid_pyramid(61, 61, {10, 3});
    WarpEdit first = move_near({18, 30}, {20, 0}, 0, WarpSolver::kInjective),
             second = move_near({30, 42}, {0, -20}, 0, WarpSolver::kInjective);
    first.pins.resize(1);
    first.pins[0].border = true;
    second.pins.resize(1);
    second.pins[0].near = {42, 30};
    const WarpEdit coarse = move_near({30, 30}, {2, 3}, 1, WarpSolver::kInjective);
    const EditSolution solution = edit_solution(m, {first, coarse, second});
    CHECK(solution.left == std::vector<double>{0, 0});
    CHECK(missed_places(solution).empty());
    WarpEdit both = first;
    both.handles.push_back(second.handles[0]);
    both.pins.push_back(second.pins[0]);
    CHECK(solve_edits(m, {both})[0] == solution.moves[0]);
    CHECK(solve_edits(m, {second, first})[0] == solution.moves[0]);
    CHECK(solve_edits(m, {coarse})[1] == solution.moves[1]);
    CHECK_NOTHROW(warp_mesh_image(m, {solution.moves[0], {}}));
    for (const Vec2f& p : m.levels[0].mesh.position)
        if (p.minCoeff() == 0 || p.maxCoeff() == 60)
            CHECK(solution.moves[0][as_index(&p - m.levels[0].mesh.position.data())] == Vec2f(0, 0));
    // What other solvers do is added.
    const WarpEdit direct = move_near({60, 60}, {1, 2});
    const VertexMoves sum = solve_edits(m, {direct, first, second})[0];
    CHECK(sum.back() == Vec2f(1, 2));
    CHECK(VertexMoves(sum.begin(), sum.end() - 1) ==
          VertexMoves(solution.moves[0].begin(), solution.moves[0].end() - 1));
}

// A pixel map that crowds pixels at one corner of each face folds them where faces are stretched unevenly; by
// their place they do not.
TEST_CASE("edit_field: pixels of injective edits move with the face that covers them") {
    MeshImage m = grid_pyramid(61, 61, {6, 2});
    WarpEdit edit = move_near({30, 30}, {14, 6}, 0, WarpSolver::kInjective);
    edit.pins.resize(1);
    edit.pins[0].border = true;
    const EditSolution solution = edit_solution(m, {edit});
    const DisplacementField expected = displacement_field(m, solution.moves);
    CHECK(folded_cells(expected) == 0);
    PixelMap& map = m.levels[0].map;
    for (std::size_t i = 0; i < map.pixel_count(); ++i)
        map[i] = {map[i].face, map[i].u * map[i].u, map[i].v * map[i].v};
    CHECK(folded_cells(displacement_field(m, solution.moves)) > 0);
    // On an edge, either face gives the same but for rounding.
    const DisplacementField found = edit_field(m, solution);
    for (std::size_t i = 0; i < map.pixel_count(); ++i)
        CHECK((found.move[i] - expected.move[i]).norm() < 1e-4f);
    edit.solver = WarpSolver::kArap;
    const EditSolution rigid = edit_solution(m, {edit});
    CHECK(edit_field(m, rigid).move == displacement_field(m, rigid.moves).move);
}

// Pixels of the mask that no face covers move as the face beside them does.
TEST_CASE("edit_field: a pixel beside the mesh moves along") {
    MeshImage m = grid_pyramid(41, 41, {4});
    Level& level = m.levels[0];
    std::erase_if(level.mesh.faces, [&](const Face& face) {
        return std::ranges::all_of(face, [&](Id v) { return level.mesh.position[v].x() > 25; });
    });
    m.source.has_mask = true;
    const PixelMap cover = trivial_map(level.mesh, 41, 41);
    std::size_t beside = 0;
    for (std::size_t i = 0; i < cover.pixel_count(); ++i) {
        if (cover[i].face != kNone) continue;
        level.map[i] = {};
        // Two columns of pixels on no face are in the mask.
        if (cover.x_of(i) > 1 && cover[i - 2].face != kNone) {
            level.map[i] = {cover[i - 2].face, 0, 0};
            ++beside;
        }
    }
    REQUIRE(beside > 30);
    WarpEdit edit = move_near({0, 20}, {-6, 2}, 0, WarpSolver::kInjective);
    edit.pins.resize(1);
    edit.pins[0].box = {19, 0, 21, 40};
    const DisplacementField field = edit_field(m, edit_solution(m, {edit}));
    for (std::size_t i = 0; i < field.move.size(); ++i)
        if (field.role[i] == PixelRole::kInside && cover.x_of(i) > 0) {
            const bool left_inside = field.role[i - 1] == PixelRole::kInside;
            if (left_inside) CHECK((field.move[i] - field.move[i - 1]).norm() < 0.9f);
        }
    CHECK(folded_cells(field) == 0);
}

TEST_CASE("edit_solution: tells by level how far a handle stays from its place") {
    const MeshImage m = grid_pyramid(31, 31, {3, 1});
    WarpEdit edit = move_near({0, 0}, {40, 40}, 1, WarpSolver::kInjective);
    edit.pins.resize(1);
    edit.pins[0].border = true;
    const EditSolution solution = edit_solution(m, {edit});
    CHECK(solution.left[0] == 0);
    CHECK(solution.left[1] > 20);
    CHECK_NOTHROW(warp_mesh_image(m, solution.moves));
    REQUIRE(missed_places(solution).size() == 1);
    CHECK(missed_places(solution)[0].starts_with("level 1: a handle stays "));
}

TEST_CASE("ArapSolver: fixed vertices turned rigidly turn the mesh") {
    const BaseMesh mesh = jittered_grid(0, 0, 60, 40, 7, 5, 4);
    const std::vector<Id> fixed = {3, 20, 41};
    for (const double angle : {20.0, 110.0, -170.0}) {
        std::vector<Vec2d> moves;
        for (const Id v : fixed) {
            const Vec2d p = mesh.position[v].cast<double>();
            moves.push_back(turned(p, {12, 50}, angle) + Vec2d(3, 4) - p);
        }
        const ArapSolver::Result result = ArapSolver(mesh, fixed).solve(moves);
        for (Id v = 0; v < mesh.vertex_count(); ++v) {
            const Vec2d p = mesh.position[v].cast<double>();
            CHECK((p + result.moves[v] - turned(p, {12, 50}, angle) - Vec2d(3, 4)).norm() < 1e-6);
        }
    }
}

// Bending a bar by half a turn: lengths of edges hardly change, which linear interpolation could not do.
TEST_CASE("ArapSolver: a bar bends without shrinking") {
    const BaseMesh mesh = jittered_grid(0, 0, 100, 12, 20, 2, 4);
    std::vector<Id> fixed;
    std::vector<Vec2d> moves;
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2d p = mesh.position[v].cast<double>();
        if (p.x() == 0) moves.emplace_back(0, 0);
        if (p.x() == 100) moves.push_back(turned(p, {100, 6}, 90) + Vec2d(-35, -60) - p);
        if (moves.size() > fixed.size()) fixed.push_back(v);
    }
    const ArapSolver solver(mesh, fixed);
    const ArapSolver::Result result = solver.solve(moves, 1e-4, 2000);
    CHECK(result.iterations < 2000);
    double rest = 0, bent = 0, worst = 0;
    for (const auto& [a, b] : mesh_edges(mesh)) {
        const Vec2d d = (mesh.position[a] - mesh.position[b]).cast<double>();
        const double after = (d + result.moves[a] - result.moves[b]).norm();
        rest += d.norm();
        bent += after;
        worst = std::max(worst, std::abs(after / d.norm() - 1));
    }
    CHECK(bent / rest == doctest::Approx(1).epsilon(0.05));
    CHECK(worst < 0.5);
    for (std::size_t i = 0; i < fixed.size(); ++i) CHECK(result.moves[fixed[i]] == moves[i]);
    // The kept factors do not depend on earlier solutions.
    solver.solve(std::vector<Vec2d>(fixed.size(), Vec2d(1, 2)));
    CHECK(solver.solve(moves, 1e-4, 2000).moves == result.moves);
}

TEST_CASE("ArapSolver: parts without a fixed vertex stay; needles do not break it") {
    BaseMesh mesh = jittered_grid(0, 0, 20, 20, 2, 2, 1);
    const auto first = static_cast<Id>(mesh.vertex_count());
    // Far away, and so flat that one cotangent is -80.
    for (const Vec2f& p : {Vec2f(100, 100), Vec2f(180, 100), Vec2f(140, 99.5f), Vec2f(140, 180)})
        mesh.position.push_back(p);
    mesh.faces.push_back({first, first + 1, first + 2});
    mesh.faces.push_back({first, first + 3, first + 1});
    const ArapSolver::Result one = ArapSolver(mesh, {0, 8}).solve({Vec2d(5, 0), Vec2d(0, 5)});
    for (Id v = first; v < first + 4; ++v) CHECK(one.moves[v] == Vec2d(0, 0));
    const ArapSolver::Result other =
        ArapSolver(mesh, {first, first + 1}).solve({Vec2d(0, 0), Vec2d(-20, 30)});
    for (const Vec2d& m : other.moves) CHECK(m.allFinite());
    CHECK(other.moves[0] == Vec2d(0, 0));
    CHECK(other.moves[first + 3].norm() > 1);
}

TEST_CASE("warp_mesh_image: vertices move as the pixels around them do, on the grid") {
    const MeshImage m = grid_pyramid(61, 61, {10, 2});
    const auto moves = solve_edits(m, {move_near({30, 30}, {4.02, -3}, 1)});
    const MeshImage warped = warp_mesh_image(m, moves);
    const DisplacementField field = displacement_field(m, moves);
    for (const Level& level : warped.levels)
        for (const Vec2f& p : level.mesh.position) CHECK(p == Vec2f(snapped(p.x()), snapped(p.y())));
    for (Id v = 0; v < m.levels[1].mesh.vertex_count(); ++v) {
        const Vec2f p = m.levels[1].mesh.position[v], q = warped.levels[1].mesh.position[v];
        CHECK((q - p - moves[1][v]).norm() < 0.03f);
    }
    double farthest = 0;
    for (Id v = 0; v < m.levels[0].mesh.vertex_count(); ++v) {
        const Vec2f p = m.levels[0].mesh.position[v], d = warped.levels[0].mesh.position[v] - p;
        const Vec2f near = field.move[field.index(static_cast<int>(std::lround(p.x())),
                                                  static_cast<int>(std::lround(p.y())))];
        CHECK((d - near).norm() < 0.3f);  // a pixel away at most, where the field changes by 0.25 a pixel
        farthest = std::max(farthest, double(d.norm()));
    }
    CHECK(farthest > 3);
    CHECK(warped.parameters.back().first == "warp");
    CHECK(warp_mesh_image(m, {{}, {}}).levels[0].mesh.position == m.levels[0].mesh.position);
}

TEST_CASE("warp_mesh_image: no face turns over") {
    const MeshImage m = grid_pyramid(31, 31, {3});
    CHECK_THROWS_AS(warp_mesh_image(m, solve_edits(m, {move_near({10, 10}, {40, 0})})), Error);
    WarpEdit far = move_near({0, 0}, {200000, 0});
    far.handles[0].vertices = {};
    far.handles[0].vertices.box = {0, 0, 30, 30};
    CHECK_THROWS_AS(warp_mesh_image(m, solve_edits(m, {far})), Error);
}
