#include "libcore/mesh/tile_sides.h"

#include <algorithm>

#include "libcore/base/index.h"

namespace imgmesh {

std::vector<std::uint8_t> vertices_on_sides(const BaseMesh& mesh, const GridSize& image) {
    std::vector<std::uint8_t> out;
    out.reserve(mesh.vertex_count());
    for (const Vec2f& place : mesh.position) out.push_back(on_side(place, image.width, image.height));
    return out;
}

bool set_side_features(BaseMesh& mesh, const TileSides& sides, const GridSize& image) {
    bool all = true;
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2f& place = mesh.position[v];
        if (!on_side(place, image.width, image.height)) continue;
        const bool across = place.y() == 0 || place.y() == static_cast<float>(image.height - 1);
        const Side& side = across ? (place.y() == 0 ? sides.top : sides.bottom)
                                  : (place.x() == 0 ? sides.left : sides.right);
        const float at = across ? place.x() : place.y();
        const auto found = std::ranges::lower_bound(side.vertices, at, {},
                                                    [](int pixel) { return static_cast<float>(pixel); });
        if (found == side.vertices.end() || static_cast<float>(*found) != at) {
            all = false;
            continue;
        }
        const auto n = static_cast<std::size_t>(found - side.vertices.begin()) * as_index(mesh.channels);
        std::copy_n(side.features.begin() + static_cast<std::ptrdiff_t>(n), mesh.channels,
                    mesh.feature_of(v));
    }
    return all;
}

}  // namespace imgmesh
