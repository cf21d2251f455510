#include "formats/gltf/mesh_lint.h"

#include <algorithm>
#include <utility>

#include "formats/findings/findings.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// A side of one pixel counts as a strip around it, and so do single pixels of a masked image; with a texture
// the mesh covers whole pixels (docs/format.md).
std::pair<float, float> span_of(int side, bool whole_pixels) {
    if (side == 1 || whole_pixels) return {-0.5f, static_cast<float>(side) - 0.5f};
    return {0.0f, static_cast<float>(side - 1)};
}

void lint_vertices(const StoredMesh& mesh, const AssetLevel& level, const SourceInfo& source,
                   Findings& findings) {
    const bool whole_pixels = source.has_mask || !mesh.texcoord.empty();
    const auto [left, right] = span_of(source.width, whole_pixels);
    const auto [top, bottom] = span_of(source.height, whole_pixels);
    Repeated outside(findings, "mesh.outside");
    for (std::size_t v = 0; v < mesh.position.size(); ++v) {
        const auto& p = mesh.position[v];
        if (p[0] < left || p[0] > right || -p[1] < top || -p[1] > bottom)
            outside.hit(
                [&] { return std::pair(cat("vertex ", v, " is at (", p[0], ",", p[1], ")"), Place()); });
    }
    Repeated off_texture(findings, "mesh.texcoord");
    for (std::size_t v = 0; v < mesh.texcoord.size(); ++v) {
        const auto& [x, y] = mesh.texcoord[v];
        if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1))
            off_texture.hit([&, &x = x, &y = y] {
                return std::pair(cat("vertex ", v, " is at (", x, ",", y, ") of the texture"), Place());
            });
    }
    const Bounds found = bounds_of(mesh.position);
    if (found != level.bounds) {
        const auto& [low, high] = found;
        findings.add("mesh.bounds", cat("x from ", low[0], " to ", high[0], " and y from ", low[1], " to ",
                                        high[1], " in the mesh, x from ", level.bounds.low[0], " to ",
                                        level.bounds.high[0], " and y from ", level.bounds.low[1], " to ",
                                        level.bounds.high[1], " in the accessor"));
    }
    std::vector<bool> used(mesh.position.size());
    for (const Face& face : mesh.faces)
        for (const Id v : face) used[v] = true;
    Repeated unused(findings, "mesh.unused_vertex");
    for (std::size_t v = 0; v < used.size(); ++v)
        if (!used[v]) unused.hit([&] { return std::pair(cat("vertex ", v, " has no face"), Place()); });
}

void lint_faces(const StoredMesh& mesh, const SourceInfo& source, Findings& findings) {
    std::vector<Face> faces = mesh.faces;
    std::vector<std::pair<Id, Id>> edges;  // with their direction
    double area2 = 0;
    for (Face& face : faces) {
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(face[i], face[(i + 1) % 3]);
        std::array<Vec2f, 3> p;
        for (std::size_t i = 0; i < 3; ++i) p[i] = {mesh.position[face[i]][0], -mesh.position[face[i]][1]};
        area2 += signed_area2(p[0], p[1], p[2]);
    }
    std::sort(faces.begin(), faces.end());
    const auto twice = std::adjacent_find(faces.begin(), faces.end());
    if (twice != faces.end())
        findings.add("mesh.duplicate_face",
                     cat("the face of the vertices ", (*twice)[0], ", ", (*twice)[1], ", ", (*twice)[2]));
    std::sort(edges.begin(), edges.end());
    Repeated nonmanifold(findings, "mesh.nonmanifold");
    for (std::size_t e = 1; e < edges.size() && twice == faces.end(); ++e)
        if (edges[e] == edges[e - 1])
            nonmanifold.hit([&] {
                return std::pair(cat("the edge from vertex ", edges[e].first, " to ", edges[e].second),
                                 Place());
            });
    const auto extent = [](int side) { return double(side == 1 ? 1 : side - 1); };
    const double whole = extent(source.width) * extent(source.height);  // exact, as the sum is
    const bool outer = !mesh.texcoord.empty() && area2 == 2 * double(source.width) * double(source.height);
    if (!source.has_mask && area2 != 2 * whole && !outer)
        findings.add("mesh.area", cat("the faces have an area of ", area2 / 2, ", the image ", whole));
}

}  // namespace

void lint_mesh(const StoredMesh& mesh, const AssetLevel& level, const SourceInfo& source,
               Findings& findings) {
    lint_vertices(mesh, level, source, findings);
    lint_faces(mesh, source, findings);
}

}  // namespace imgmesh
