#include "libcore/metrics/quality_distributions.h"

#include <algorithm>
#include <utility>

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
    const auto width = static_cast<std::size_t>(map.width);
    std::vector<float> jumps, displacements;
    jumps.reserve(2 * image.size());
    displacements.reserve(image.size());
    for (std::size_t i = 0; i < image.size(); ++i) {
        const std::size_t x = i % width;
        displacements.push_back(static_cast<float>((image[i] - Vec2d(double(x), double(i / width))).norm()));
        if (x + 1 < width) jumps.push_back(static_cast<float>((image[i] - image[i + 1]).norm()));
        if (i + width < image.size())
            jumps.push_back(static_cast<float>((image[i] - image[i + width]).norm()));
    }

    std::vector<std::int64_t> pixels(mesh.faces.size());
    for (const PixelCoord& coord : map.coords)
        if (coord.face < mesh.faces.size()) ++pixels[coord.face];
    std::vector<float> patch_per_area;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const double area = area2_of(mesh, mesh.faces[f]) / 2;
        if (area > 0) patch_per_area.push_back(static_cast<float>(static_cast<double>(pixels[f]) / area));
    }
    return {distribution(std::move(jumps), kJumpBins),
            distribution(std::move(displacements), kDisplacementBins),
            distribution(std::move(patch_per_area), kAreaBins), std::count(pixels.begin(), pixels.end(), 0)};
}

}  // namespace imgmesh
