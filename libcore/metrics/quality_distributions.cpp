#include "libcore/metrics/quality_distributions.h"

#include <algorithm>
#include <utility>

#include "libcore/base/grid_neighbors.h"
#include "libcore/metrics/metrics.h"
#include "libcore/metrics/triangle_shape.h"

namespace imgmesh {
namespace {

// Counts the edges at each vertex in use.
std::vector<float> valences(const BaseMesh& mesh) {
    std::vector<float> valence(mesh.vertex_count());
    for (const auto& [p, q] : mesh_edges(mesh)) {
        ++valence[p];
        ++valence[q];
    }
    std::erase(valence, 0.0f);
    return valence;
}

double area2_of(const BaseMesh& mesh, const Face& face) {
    return signed_area2(mesh.position[face[0]], mesh.position[face[1]], mesh.position[face[2]]);
}

}  // namespace

MeshDistributions mesh_distributions(const BaseMesh& mesh) {
    std::vector<TriangleShape> shapes;
    shapes.reserve(mesh.faces.size());
    for (const Face& face : mesh.faces) {
        if (area2_of(mesh, face) > 0)
            shapes.push_back(
                triangle_shape(mesh.position[face[0]], mesh.position[face[1]], mesh.position[face[2]]));
    }
    const auto over_faces = [&](double TriangleShape::*measure, const Bins& bins) {
        std::vector<float> values;
        values.reserve(shapes.size());
        for (const TriangleShape& s : shapes) values.push_back(static_cast<float>(s.*measure));
        return distribution(std::move(values), bins);
    };
    return {distribution(valences(mesh), kValenceBins),
            over_faces(&TriangleShape::edge_ratio, kRatioBins),
            over_faces(&TriangleShape::aspect_ratio, kRatioBins),
            over_faces(&TriangleShape::radius_ratio, kUnitBins),
            over_faces(&TriangleShape::radius_edge_ratio, kRadiusEdgeBins),
            over_faces(&TriangleShape::shape, kUnitBins),
            over_faces(&TriangleShape::min_angle_deg, kAngleBins)};
}

MapDistributions map_distributions(const BaseMesh& mesh, const PixelMap& map) {
    // Positions of pixels without a face are NaN. So are distances to them, which therefore do not count.
    const std::vector<Vec2d> image = mapped_positions(mesh, map);
    std::vector<float> jumps, displacements;
    jumps.reserve(2 * image.size());
    displacements.reserve(image.size());
    const auto add_distance = [](std::vector<float>& to, const Vec2d& a, const Vec2d& b) {
        to.push_back(static_cast<float>((a - b).norm()));
    };
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) add_distance(displacements, image[map.index(x, y)], Vec2d(x, y));
    for_neighbor_pixels(map, [&](std::size_t i, std::size_t j) { add_distance(jumps, image[i], image[j]); });

    std::vector<std::int64_t> pixels(mesh.faces.size());
    for (const PixelCoord& coord : map)
        if (coord.face < mesh.faces.size()) ++pixels[coord.face];
    std::vector<float> patch_per_area;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const double area = area2_of(mesh, mesh.faces[f]) / 2;
        if (area > 0) patch_per_area.push_back(static_cast<float>(double(pixels[f]) / area));
    }
    return {distribution(std::move(jumps), kJumpBins),
            distribution(std::move(displacements), kDisplacementBins),
            distribution(std::move(patch_per_area), kAreaBins), std::count(pixels.begin(), pixels.end(), 0)};
}

}  // namespace imgmesh
