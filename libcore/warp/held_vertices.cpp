#include "libcore/warp/held_vertices.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libcore/base/error.h"
#include "libcore/warp/ordered_mesh.h"

namespace imgmesh {
namespace {

[[noreturn]] void fail(const std::string& where, const std::string& text) {
    throw Error(ErrorKind::kBadFile, cat(where, ": ", text));
}

Id nearest_vertex(const BaseMesh& mesh, const Vec2d& point) {
    Id best = 0;
    double least = (mesh.position[0].cast<double>() - point).squaredNorm();
    for (Id v = 1; v < mesh.vertex_count(); ++v) {
        const double distance = (mesh.position[v].cast<double>() - point).squaredNorm();
        if (distance >= least) continue;
        least = distance;
        best = v;
    }
    return best;
}

template <typename Inside>
void add_within(const BaseMesh& mesh, const Inside& inside, std::vector<Id>& vertices) {
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        if (inside(mesh.position[v].cast<double>())) vertices.push_back(v);
}

// Returns the ends of edges with one face only.
std::vector<Id> border_vertices(const BaseMesh& mesh) {
    std::vector<std::pair<Id, Id>> edges;
    for (const auto& [a, b, c] : mesh.faces)
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            edges.push_back(std::minmax(p, q));
    std::sort(edges.begin(), edges.end());
    std::vector<Id> border;
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        while (end < edges.size() && edges[end] == edges[i]) ++end;
        if (end - i == 1) border.insert(border.end(), {edges[i].first, edges[i].second});
    }
    return border;
}

// Returns the selected vertices, ascending, each once; at least one.
std::vector<Id> selected(const BaseMesh& mesh, int level, const VertexSelection& s) {
    std::vector<Id> vertices = s.vertices;
    for (const Id v : vertices)
        if (v >= mesh.vertex_count())
            fail(s.where, cat("vertex ", v, " is not there; level ", level, " has vertices 0 to ",
                              mesh.vertex_count() - 1));
    if (s.near) vertices.push_back(nearest_vertex(mesh, *s.near));
    const auto within = [](const std::array<double, 3>& circle, const Vec2d& p) {
        return std::hypot(p.x() - circle[0], p.y() - circle[1]) <= circle[2];
    };
    if (s.circle)
        add_within(
            mesh, [&](const Vec2d& p) { return within(*s.circle, p); }, vertices);
    if (s.beyond)
        add_within(
            mesh, [&](const Vec2d& p) { return !within(*s.beyond, p); }, vertices);
    if (s.box) {
        const auto [left, top, right, bottom] = *s.box;
        add_within(
            mesh,
            [left = left, top = top, right = right, bottom = bottom](const Vec2d& p) {
                return p.x() >= left && p.x() <= right && p.y() >= top && p.y() <= bottom;
            },
            vertices);
    }
    if (s.border) {
        const std::vector<Id> border = border_vertices(mesh);
        vertices.insert(vertices.end(), border.begin(), border.end());
    }
    if (vertices.empty()) fail(s.where, cat("no vertex of level ", level, " lies there"));
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

// Sums round: the places are sorted, as the order of vertices must not matter.
Vec2d mean_place(const BaseMesh& mesh, const std::vector<Id>& vertices) {
    std::vector<Vec2f> places;
    for (const Id v : vertices) places.push_back(mesh.position[v]);
    std::ranges::sort(places, is_above);
    Vec2d mean(0, 0);
    for (const Vec2f& p : places) mean += p.cast<double>() / double(places.size());
    return mean;
}

// Adds the handle's moves of its vertices to `moves`, and the vertices to `fixed`.
void apply_handle(const BaseMesh& mesh, int level, const WarpHandle& handle, std::vector<Vec2d>& moves,
                  std::vector<char>& fixed) {
    const std::vector<Id> vertices = selected(mesh, level, handle.vertices);
    const Vec2d center = handle.center ? *handle.center : mean_place(mesh, vertices);
    const double angle = handle.rotate_deg * std::numbers::pi / 180;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    for (const Id v : vertices) {
        const Vec2d from = mesh.position[v].cast<double>() - center;
        const Vec2d scaled = from.cwiseProduct(handle.scale);
        // y grows down, so a counter-clockwise turn on screen takes x to -y.
        const Vec2d to(cosine * scaled.x() + sine * scaled.y(), cosine * scaled.y() - sine * scaled.x());
        // Angle 0 and scale 1 must give exactly the move.
        moves[v] += to == from ? handle.move : Vec2d(to - from + handle.move);
        fixed[v] = 1;
        if (!moves[v].allFinite())
            fail(handle.vertices.where, cat("vertex ", v, " moves beyond all numbers"));
    }
}

}  // namespace

void HeldVertices::add(const HeldVertices& other) {
    for (std::size_t v = 0; v < moves.size(); ++v) moves[v] += other.moves[v];
    for (std::size_t v = 0; v < held.size(); ++v) held[v] |= other.held[v];
}

HeldVertices held_vertices(const BaseMesh& mesh, const WarpEdit& edit) {
    HeldVertices all(mesh.vertex_count());
    for (const WarpHandle& handle : edit.handles) apply_handle(mesh, edit.level, handle, all.moves, all.held);
    const std::vector<char> in_handle = all.held;
    for (const VertexSelection& pin : edit.pins)
        for (const Id v : selected(mesh, edit.level, pin)) {
            // A border is pinned where it is free: handles on it are what pulls.
            if (in_handle[v] && !pin.border)
                fail(pin.where, cat("vertex ", v, " is also in a handle of this edit"));
            all.held[v] = 1;
        }
    return all;
}

}  // namespace imgmesh
