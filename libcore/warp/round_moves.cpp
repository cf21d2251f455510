#include "libcore/warp/round_moves.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libcore/mesh/adjacency.h"

namespace imgmesh {
namespace {

Vec2f snapped_place(const Vec2f& at, const Vec2f& move) {
    const Vec2f to = at + move;
    return {snapped(to.x()), snapped(to.y())};
}

// Whether a triangle's area is positive for certain: doubles round sums of floats and products of their
// differences, in all by less than 2^-50 of what they multiply, and coordinates by less than 2^-32 pixels.
bool is_surely_positive(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    const Vec2d ab = b - a, ac = c - a;
    const double plus = ab.y() * ac.x(), minus = ab.x() * ac.y();
    const double doubt = 0x1p-50 * (std::abs(plus) + std::abs(minus)) +
                         0x1p-30 * (1 + ab.cwiseAbs().sum() + ac.cwiseAbs().sum());
    return plus - minus > doubt;
}

bool is_open(const BaseMesh& mesh, const Face& face, std::span<const Vec2f> moves) {
    std::array<Vec2d, 3> exact;
    std::array<Vec2f, 3> round;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec2f &at = mesh.position[face[k]], &move = moves[face[k]];
        exact[k] = at.cast<double>() + move.cast<double>();
        round[k] = snapped_place(at, move);
    }
    return is_surely_positive(exact[0], exact[1], exact[2]) && signed_area2(round[0], round[1], round[2]) > 0;
}

bool counts(const BaseMesh& mesh, const std::vector<bool>& is_used, const Face& face) {
    return is_used[face[0]] &&
           signed_area2(mesh.position[face[0]], mesh.position[face[1]], mesh.position[face[2]]) > 0;
}

Vec2d grid_place(const Vec2d& at) {
    constexpr double kStep = static_cast<double>(kPositionStep);
    return {std::floor(at.x() / kStep + 0.5) * kStep, std::floor(at.y() / kStep + 0.5) * kStep};
}

// Moves the vertex to the grid place nearest to `place` with which all its faces are open. Returns whether
// there is one.
bool find_place(const BaseMesh& mesh, const std::vector<bool>& is_used, const VertexCorners& corners, Id v,
                const Vec2d& place, std::span<Vec2f> moves) {
    constexpr int kReach = 2;
    std::array<Vec2d, (2 * kReach + 1) * (2 * kReach + 1)> places;
    std::size_t count = 0;
    const Vec2d middle = grid_place(place);
    for (int dy = -kReach; dy <= kReach; ++dy)
        for (int dx = -kReach; dx <= kReach; ++dx)
            places[count++] = middle + static_cast<double>(kPositionStep) * Vec2d(dx, dy);
    std::ranges::stable_sort(places, {}, [&](const Vec2d& to) { return (to - place).squaredNorm(); });
    const Vec2f before = moves[v];
    for (const Vec2d& to : places) {
        moves[v] = (to - mesh.position[v].cast<double>()).cast<float>();
        bool open = true;
        for (const std::size_t corner : corners.of(v)) {
            const Face& face = mesh.faces[corner / 3];
            open = open && (!counts(mesh, is_used, face) || is_open(mesh, face, moves));
        }
        if (open) return true;
    }
    moves[v] = before;
    return false;
}

}  // namespace

bool keeps_faces(const BaseMesh& mesh, const std::vector<bool>& is_used, std::span<const Vec2f> moves) {
    return std::ranges::all_of(mesh.faces, [&](const Face& face) {
        return !counts(mesh, is_used, face) || is_open(mesh, face, moves);
    });
}

bool round_moves(const BaseMesh& mesh, const std::vector<bool>& is_used, const std::vector<bool>& is_free,
                 std::span<const Vec2d> place, std::span<Vec2f> moves) {
    for (Id v = 0; v < moves.size(); ++v)
        if (is_free[v]) moves[v] = (grid_place(place[v]) - mesh.position[v].cast<double>()).cast<float>();
    if (keeps_faces(mesh, is_used, moves)) return true;
    const VertexCorners corners = vertex_corners(mesh.faces, mesh.vertex_count());
    // A vertex may find a place once its neighbours have theirs.
    constexpr int kPasses = 4;
    for (int pass = 0; pass < kPasses; ++pass)
        for (const Face& face : mesh.faces) {
            if (!counts(mesh, is_used, face)) continue;
            for (const Id v : face) {
                if (is_open(mesh, face, moves)) break;
                if (is_free[v]) find_place(mesh, is_used, corners, v, place[v], moves);
            }
        }
    return keeps_faces(mesh, is_used, moves);
}

}  // namespace imgmesh
