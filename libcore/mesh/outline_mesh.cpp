#include "libcore/mesh/outline_mesh.h"

#include <algorithm>

#include "libcore/base/error.h"
#include "libcore/mesh/triangulate.h"

namespace imgmesh {

MeshImage outline_mesh_image(const MeshImage& mesh_image, int level_index, double tolerance,
                             OutlineSide side) {
    if (level_index < 0 || level_index >= std::ssize(mesh_image.levels))
        throw Error(ErrorKind::kBadArgument,
                    cat("level is ", level_index, ", expected 0 to ", std::ssize(mesh_image.levels) - 1));
    const Level& from = mesh_image.levels[as_index(level_index)];
    Mask mask{from.map.width, from.map.height, {}};
    for (const PixelCoord& coord : from.map) mask.values.push_back(coord.face != kNone);

    MeshImage out{mesh_image.source, {}, {}, mesh_image.generator, mesh_image.parameters};
    out.source.has_mask = true;  // an empty map has no pixel
    Level& level = out.levels.emplace_back();
    level.mesh = triangulated(simplified_outline(mask, tolerance, side));
    level.mesh.channels = from.mesh.channels;
    for (const Vec2f& p : level.mesh.position) {
        const auto nearest = std::ranges::min_element(from.mesh.position, {},
                                                      [&](const Vec2f& q) { return (q - p).squaredNorm(); });
        const float* feature = from.mesh.feature_of(as_id(nearest - from.mesh.position.begin()));
        level.mesh.feature.insert(level.mesh.feature.end(), feature, feature + from.mesh.channels);
    }
    level.map = from.map;
    std::fill(level.map.begin(), level.map.end(), PixelCoord{kNone, 0, 0});
    return out;
}

}  // namespace imgmesh
