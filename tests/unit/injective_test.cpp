// Deformation in which no face turns over.
#include "libcore/warp/injective.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "libcore/mesh/exact_face.h"
#include "libcore/warp/face_energy.h"
#include "tests/support/meshes.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

using Form = EnergyKind::Form;

std::vector<Vec2d> places(const BaseMesh& mesh) {
    std::vector<Vec2d> all;
    for (const Vec2f& p : mesh.position) all.push_back(p.cast<double>());
    return all;
}

// The faces that are turned over or flat, of what a container holds and of what was returned.
int folds(const BaseMesh& mesh, const std::vector<Vec2f>& moves) {
    BaseMesh moved = mesh;
    int count = 0;
    for (Id v = 0; v < moved.vertex_count(); ++v) {
        const Vec2f to = mesh.position[v] + moves[v];
        moved.position[v] = {snapped(to.x()), snapped(to.y())};
    }
    for (const ExactFace& face : exact_faces(moved)) count += face.area <= 0;
    for (const auto& [a, b, c] : mesh.faces) {
        const Vec2d p = mesh.position[a].cast<double>() + moves[a].cast<double>(),
                    q = mesh.position[b].cast<double>() + moves[b].cast<double>(),
                    r = mesh.position[c].cast<double>() + moves[c].cast<double>();
        count += !((q - p).y() * (r - p).x() - (q - p).x() * (r - p).y() > 0);
    }
    return count;
}

// A ring: a grid without the faces in the middle and at the corners, and without their vertices.
BaseMesh ring(int side, int cells) {
    const BaseMesh grid = jittered_grid(0, 0, side, side, cells, cells, 9);
    BaseMesh mesh;
    std::vector<Id> number(grid.vertex_count(), kNone);
    for (Face face : grid.faces) {
        const Vec2f middle = (grid.position[face[0]] + grid.position[face[1]] + grid.position[face[2]]) / 3;
        const float radius = (middle - Vec2f::Constant(static_cast<float>(side) / 2)).norm() / float(side);
        if (radius < 0.2f || radius > 0.48f) continue;
        for (Id& v : face) {
            if (number[v] == kNone) {
                number[v] = as_id(mesh.position.size());
                mesh.position.push_back(grid.position[v]);
            }
            v = number[v];
        }
        mesh.faces.push_back(face);
    }
    return mesh;
}

struct Drag {
    std::vector<Id> fixed;
    std::vector<Vec2d> moves;
};

// One to six handles and up to eight pins anywhere, moved by up to `far` along each axis.
Drag random_drag(std::mt19937& random, const BaseMesh& mesh, double far) {
    const std::size_t handles = 1 + random() % 6, pins = random() % 9;
    std::vector<std::pair<Id, Vec2d>> all;
    for (std::size_t i = 0; i < handles + pins; ++i) {
        const auto v = static_cast<Id>(random() % mesh.vertex_count());
        const auto along = [&] { return i < handles ? far * (double(random() % 2001) / 1000 - 1) : 0.0; };
        const double x = along(), y = along();
        if (std::ranges::none_of(all, [v](const auto& one) { return one.first == v; }))
            all.emplace_back(v, Vec2d(x, y));
    }
    std::ranges::sort(all, {}, [](const auto& one) { return one.first; });
    Drag drag;
    for (const auto& one : all) {
        drag.fixed.push_back(one.first);
        drag.moves.push_back(one.second);
    }
    return drag;
}

}  // namespace

TEST_CASE("FaceEnergies: gradients are those of finite differences, and Hessians too") {
    const BaseMesh mesh = jittered_grid(0, 0, 30, 20, 3, 2, 5);
    const FaceEnergies energies(mesh, std::vector<bool>(mesh.vertex_count(), true));
    std::mt19937 random(3);
    for (const EnergyKind& kind :
         {EnergyKind{Form::kRigid, 0}, EnergyKind{Form::kUntangle, 0.3}, EnergyKind{Form::kBarrier, 0}}) {
        std::vector<Vec2d> place = places(mesh), slope(place.size()), other(place.size());
        // Small moves turn nothing over; large ones, for the energies that allow it, turn faces over.
        const double far = kind.form == Form::kBarrier ? 1.0 : 20.0;
        for (Vec2d& p : place)
            p += far * Vec2d(double(random() % 1001) / 1000, double(random() % 1001) / 1000);
        CHECK((energies.least_determinant(place) > 0) == (kind.form == Form::kBarrier));
        energies.evaluate(kind, place, slope);
        constexpr double kStep = 1e-5;
        for (std::size_t v = 0; v < place.size(); ++v)
            for (int axis = 0; axis < 2; ++axis) {
                const double at = place[v][axis];
                place[v][axis] = at + kStep;
                const double above = energies.evaluate(kind, place, other);
                place[v][axis] = at - kStep;
                const double below = energies.evaluate(kind, place, other);
                place[v][axis] = at;
                CHECK((above - below) / (2 * kStep) == doctest::Approx(slope[v][axis]).epsilon(1e-5));
            }
    }
}

// Near the mesh at rest turned, whose energy is least, the Hessian is positive semidefinite as it is.
TEST_CASE("FaceEnergies: the Hessian is the gradient's derivative") {
    BaseMesh mesh;
    mesh.position = {{0, 0}, {1, 9}, {8, 2}};
    mesh.faces = {{0, 1, 2}};
    const FaceEnergies energies(mesh, {true, true, true});
    const EnergyKind kind{Form::kBarrier, 0};
    std::vector<Vec2d> place;
    for (const Vec2d& p : places(mesh))
        place.emplace_back(0.8 * p.x() - 0.6 * p.y(), 0.6 * p.x() + 0.8 * p.y());
    place[1].x() *= 1.2;
    std::vector<double> entries;
    energies.hessian(kind, place, [&](double value) { entries.push_back(value); });
    REQUIRE(entries.size() == 36);
    constexpr double kStep = 1e-5;
    for (std::size_t l = 0; l < 3; ++l)
        for (int c = 0; c < 2; ++c) {
            std::vector<Vec2d> above(3), below(3);
            place[l][c] += kStep;
            energies.evaluate(kind, place, above);
            place[l][c] -= 2 * kStep;
            energies.evaluate(kind, place, below);
            place[l][c] += kStep;
            for (std::size_t k = 0; k < 3; ++k)
                for (int r = 0; r < 2; ++r)
                    CHECK(entries[(k * 3 + l) * 4 + as_index(2 * r + c)] ==
                          doctest::Approx((above[k][r] - below[k][r]) / (2 * kStep)).epsilon(1e-4));
        }
}

// The third corner crosses the opposite side, x = 0, after half of its way.
TEST_CASE("FaceEnergies: the largest step ends where a face has no area") {
    BaseMesh mesh;
    mesh.position = {{0, 0}, {0, 4}, {4, 2}};
    mesh.faces = {{0, 1, 2}};
    REQUIRE(signed_area2(mesh.position[0], mesh.position[1], mesh.position[2]) > 0);
    const FaceEnergies energies(mesh, {true, true, true});
    const auto step = [&](const Vec2d& move) {
        return energies.largest_step(places(mesh), std::vector<Vec2d>{{0, 0}, {0, 0}, move});
    };
    CHECK(step({-8, 100}) == doctest::Approx(0.5));
    CHECK(step({-3.9, 0}) == 1);
    CHECK(step({9, 0}) == 1);
    // Shrinking to a point: a double root.
    CHECK(energies.largest_step(places(mesh), std::vector<Vec2d>{{0, 0}, {0, -8}, {-8, -4}}) ==
          doctest::Approx(0.5));
}

TEST_CASE("InjectiveSolver: random drags fold nothing, and most handles get where they should") {
    std::mt19937 random(7);
    int reached = 0, all = 0;
    for (const BaseMesh& mesh : {jittered_grid(0, 0, 300, 200, 14, 10, 2), ring(240, 18)})
        for (int i = 0; i < 60; ++i) {
            const Drag drag = random_drag(random, mesh, 80);
            const InjectiveSolver::Result result = InjectiveSolver(mesh, drag.fixed).solve(drag.moves);
            CAPTURE(i);
            CHECK(folds(mesh, result.moves) == 0);
            ++all;
            if (result.left > 0) continue;
            ++reached;
            for (std::size_t k = 0; k < drag.fixed.size(); ++k)
                CHECK(result.moves[drag.fixed[k]] == Vec2f(drag.moves[k].cast<float>()));
        }
    CHECK(reached > 0.9 * all);
}

// As a hand drags: each step begins with what the one before has found.
TEST_CASE("InjectiveSolver: a drag in small steps folds nothing") {
    const BaseMesh mesh = jittered_grid(0, 0, 200, 200, 10, 10, 2);
    const InjectiveSolver solver(mesh, {0, 60, 120});
    std::vector<Vec2f> moves;
    for (int i = 1; i <= 40; ++i) {
        const double angle = 0.1 * i;
        const InjectiveSolver::Result result = solver.solve(
            {Vec2d(0, 0), Vec2d(2 * i * std::cos(angle), 2 * i * std::sin(angle)), Vec2d(0, 0)}, moves);
        CHECK(folds(mesh, result.moves) == 0);
        CHECK(result.left == 0);
        moves = result.moves;
    }
    // Where the last step is no help, the mesh at rest may be: a handle back to its place from beyond the
    // others.
    const InjectiveSolver::Result back = solver.solve({Vec2d(0, 0), Vec2d(0, 0), Vec2d(0, 0)}, moves);
    CHECK(folds(mesh, back.moves) == 0);
    CHECK(back.left == 0);
    // A start with a fold, or for another mesh, does not count.
    const std::vector<Vec2d> asked = {Vec2d(0, 0), Vec2d(9, 7), Vec2d(3, 0)};
    moves[7] += Vec2f(300, 0);
    CHECK(solver.solve(asked, moves).moves == solver.solve(asked).moves);
    CHECK(solver.solve(asked, {Vec2f(1, 1)}).moves == solver.solve(asked).moves);
    CHECK(InjectiveSolver(mesh, {0, 60, 120}).solve(asked).moves == solver.solve(asked).moves);
}

// A page allows few iterations for each picture of a drag. What lags behind comes nearer with each.
TEST_CASE("InjectiveSolver: few iterations fold nothing either, and repeated they get there") {
    const BaseMesh mesh = jittered_grid(0, 0, 200, 200, 10, 10, 2);
    const InjectiveSolver solver(mesh, {0, 60, 120});
    std::vector<Vec2f> moves;
    double left = 1;
    for (int i = 0; i < 60; ++i) {
        const double far = std::min(90, 6 * i);
        const InjectiveSolver::Result result =
            solver.solve({Vec2d(0, 0), Vec2d(far, far / 2), Vec2d(0, 0)}, moves, 12);
        CHECK(folds(mesh, result.moves) == 0);
        CHECK(result.iterations <= 12);
        moves = result.moves;
        left = result.left;
    }
    CHECK(left == 0);
}

// Two corners of one face change places while the third stays: no mesh does that without turning the face.
TEST_CASE("InjectiveSolver: what cannot be reached is not, and the result says how far it is") {
    const BaseMesh mesh = jittered_grid(0, 0, 60, 60, 5, 5, 3);
    Face face = mesh.faces[11];
    std::ranges::sort(face);
    const Vec2d a = mesh.position[face[0]].cast<double>(), b = mesh.position[face[1]].cast<double>();
    // A handle far away is not held back by them.
    REQUIRE(face[2] < 35);
    const InjectiveSolver solver(mesh, {face[0], face[1], face[2], 35});
    const InjectiveSolver::Result result = solver.solve({b - a, a - b, Vec2d(0, 0), Vec2d(4, -3)});
    CHECK(result.moves[35] == Vec2f(4, -3));
    CHECK(folds(mesh, result.moves) == 0);
    CHECK(result.left > 1);
    CHECK(result.left < (b - a).norm());
    CHECK(result.moves[face[2]] == Vec2f(0, 0));
    const double left0 = (result.moves[face[0]].cast<double>() - (b - a)).norm(),
                 left1 = (result.moves[face[1]].cast<double>() - (a - b)).norm();
    CHECK(result.left == doctest::Approx(std::max(left0, left1)));
    // A vertex of the boundary beyond the opposite corner of a mesh that is pinned everywhere else.
    std::vector<Id> fixed;
    for (Id v = 0; v < mesh.vertex_count(); ++v) fixed.push_back(v);
    std::vector<Vec2d> moves(fixed.size(), Vec2d(0, 0));
    moves[0] = {60, 60};
    const InjectiveSolver::Result pinned = InjectiveSolver(mesh, fixed).solve(moves);
    CHECK(folds(mesh, pinned.moves) == 0);
    CHECK(pinned.left > 50);
    for (Id v = 1; v < mesh.vertex_count(); ++v) CHECK(pinned.moves[v] == Vec2f(0, 0));
}

TEST_CASE("InjectiveSolver: no moves, equal moves and rigid moves are exact") {
    const BaseMesh mesh = jittered_grid(0, 0, 60, 40, 7, 5, 4);
    const InjectiveSolver solver(mesh, {3, 20, 41});
    for (const Vec2f& m : solver.solve({Vec2d(0, 0), Vec2d(0, 0), Vec2d(0, 0)}).moves)
        CHECK(m == Vec2f(0, 0));
    const Vec2d move(4.02, -1000.3);
    const InjectiveSolver::Result shifted = solver.solve({move, move, move});
    CHECK(shifted.left == 0);
    for (const Vec2f& m : shifted.moves) CHECK(m == Vec2f(4.02f, -1000.3f));
    // A half turn about (30, 20): every vertex goes to the opposite side, up to rounding.
    std::vector<Vec2d> moves;
    for (const Id v : {3u, 20u, 41u}) moves.push_back(2 * (Vec2d(30, 20) - mesh.position[v].cast<double>()));
    const InjectiveSolver::Result turned = solver.solve(moves);
    CHECK(turned.left == 0);
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        CHECK((2 * (Vec2f(30, 20) - mesh.position[v]) - turned.moves[v]).norm() < 0.05f);
}

TEST_CASE("InjectiveSolver: parts without a fixed vertex stay, the others go their own ways") {
    BaseMesh mesh = jittered_grid(0, 0, 20, 20, 2, 2, 1);
    // Two triangles far away, the second without area.
    for (const Vec2f& p : {Vec2f(100, 100), Vec2f(100, 140), Vec2f(140, 100), Vec2f(120, 100)})
        mesh.position.push_back(p);
    mesh.faces.push_back({9, 10, 11});
    mesh.faces.push_back({9, 12, 11});
    const auto bent = InjectiveSolver(mesh, {0, 8}).solve({Vec2d(5, 0), Vec2d(0, 5)});
    CHECK(bent.left == 0);
    for (Id v = 9; v < 13; ++v) CHECK(bent.moves[v] == Vec2f(0, 0));
    CHECK(bent.moves[4] != Vec2f(0, 0));
    const auto both = InjectiveSolver(mesh, {0, 9, 12}).solve({Vec2d(0.3, 0), Vec2d(-20, 7), Vec2d(1, 1)});
    CHECK(both.left == 0);
    for (Id v = 0; v < 9; ++v) CHECK(both.moves[v] == Vec2f(0.3f, 0));
    for (Id v = 9; v < 12; ++v) CHECK(both.moves[v] == Vec2f(-20, 7));
    CHECK(both.moves[12] == Vec2f(1, 1));
    // Nothing is fixed.
    for (const Vec2f& m : InjectiveSolver(mesh, {}).solve({}).moves) CHECK(m == Vec2f(0, 0));
}
