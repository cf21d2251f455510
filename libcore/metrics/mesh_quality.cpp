// Topology: all counts follow from the list of half-edges, sorted by their two ends.
#include <algorithm>
#include <tuple>

#include "libcore/base/disjoint_sets.h"
#include "libcore/metrics/metrics.h"
#include "libcore/metrics/triangle_shape.h"

namespace imgmesh {
namespace {

// One side of a face. Corners are numbered 3 face + place.
struct HalfEdge {
    Id low, high;
    Id low_corner, high_corner;
    bool rising;  // whether it runs from low to high
};

std::vector<HalfEdge> sorted_half_edges(const BaseMesh& mesh) {
    std::vector<HalfEdge> edges;
    edges.reserve(mesh.faces.size() * 3);
    for (Id f = 0; f < mesh.faces.size(); ++f)
        for (Id k = 0; k < 3; ++k) {
            const Id next = (k + 1) % 3;
            const Id a = mesh.faces[f][k], b = mesh.faces[f][next];
            edges.push_back(a < b ? HalfEdge{a, b, 3 * f + k, 3 * f + next, true}
                                  : HalfEdge{b, a, 3 * f + next, 3 * f + k, false});
        }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.low_corner) < std::tie(b.low, b.high, b.low_corner);
    });
    return edges;
}

void measure_topology(const BaseMesh& mesh, MeshQuality& q) {
    const std::vector<HalfEdge> edges = sorted_half_edges(mesh);
    DisjointSets fans(mesh.faces.size() * 3);  // sets of corners that are connected across shared edges
    DisjointSets components(mesh.faces.size());
    for (std::size_t first = 0, last; first < edges.size(); first = last) {
        last = first + 1;
        while (last < edges.size() && edges[last].low == edges[first].low &&
               edges[last].high == edges[first].high) {
            fans.join(edges[first].low_corner, edges[last].low_corner);
            fans.join(edges[first].high_corner, edges[last].high_corner);
            components.join(edges[first].low_corner / 3, edges[last].low_corner / 3);
            ++last;
        }
        const std::size_t faces = last - first;
        ++q.edges;
        q.boundary_edges += faces == 1;
        q.nonmanifold_edges += faces > 2 || (faces == 2 && edges[first].rising == edges[first + 1].rising);
    }
    q.components = components.count();

    std::vector<std::uint32_t> fans_at(mesh.vertex_count());
    std::vector<bool> used(mesh.vertex_count());
    for (Id corner = 0; corner < mesh.faces.size() * 3; ++corner) {
        const Id v = mesh.faces[corner / 3][corner % 3];
        used[v] = true;
        fans_at[v] += fans.find(corner) == corner;
    }
    q.nonmanifold_vertices = std::count_if(fans_at.begin(), fans_at.end(), [](auto n) { return n > 1; });
    const std::int64_t used_vertices = std::count(used.begin(), used.end(), true);
    q.euler = used_vertices - q.edges + q.faces;
    if (used_vertices > 0) q.mean_valence = 2 * double(q.edges) / double(used_vertices);
}

void measure_shape(const BaseMesh& mesh, MeshQuality& q) {
    std::int64_t positive = 0;
    q.min_shape = mesh.faces.empty() ? 0 : 1;
    q.min_angle_deg = mesh.faces.empty() ? 0 : 60;
    for (const auto& [ia, ib, ic] : mesh.faces) {
        const Vec2f &a = mesh.position[ia], &b = mesh.position[ib], &c = mesh.position[ic];
        const double area2 = signed_area2(a, b, c);
        q.area += area2 / 2;
        if (!(area2 > 0)) {
            ++q.flipped_faces;
            q.min_shape = q.min_angle_deg = 0;
            continue;
        }
        ++positive;
        const TriangleShape s = triangle_shape(a, b, c);
        q.mean_edge_ratio += s.edge_ratio;
        q.mean_radius_ratio += s.radius_ratio;
        q.mean_shape += s.shape;
        q.min_shape = std::min(q.min_shape, s.shape);
        q.min_angle_deg = std::min(q.min_angle_deg, s.min_angle_deg);
    }
    if (positive == 0) return;
    for (double* mean : {&q.mean_edge_ratio, &q.mean_radius_ratio, &q.mean_shape}) *mean /= double(positive);
}

}  // namespace

MeshQuality mesh_quality(const BaseMesh& mesh) {
    MeshQuality q;
    q.vertices = std::ssize(mesh.position);
    q.faces = std::ssize(mesh.faces);
    measure_topology(mesh, q);
    measure_shape(mesh, q);
    return q;
}

}  // namespace imgmesh
