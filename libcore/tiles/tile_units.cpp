#include "libcore/tiles/tile_units.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/mesh/locate_map.h"
#include "libcore/mesh/trivial_map.h"

namespace imgmesh {
namespace {

// The pixels that lie on a face; empty() for all.
Mask covered(const BaseMesh& mesh, const GridSize& size) {
    const PixelMap map = trivial_map(mesh, size.width, size.height);
    if (std::ranges::none_of(map, [](const PixelCoord& c) { return c.face == kNone; })) return {};
    Mask mask{size.width, size.height, {}};
    for (const PixelCoord& c : map) mask.values.push_back(c.face != kNone);
    return mask;
}

}  // namespace

BaseMesh in_level_units(BaseMesh mesh, int level) {
    const float unit = std::ldexp(1.0f, level);
    for (Vec2f& p : mesh.position) p = Vec2f(snapped(p.x() / unit), snapped(p.y() / unit));
    return mesh;
}

BaseMesh in_pixels(BaseMesh mesh, int level) {
    const float unit = std::ldexp(1.0f, level);
    for (Vec2f& p : mesh.position) p *= unit;
    return mesh;
}

MeshImage coarse_image(const BaseMesh& mesh, const SourceInfo& source, const TileGrid& grid,
                       const TileName& tile) {
    MeshImage image;
    image.source = source;
    static_cast<GridSize&>(image.source) = level_size(grid, tile);
    Level& level = image.levels.emplace_back();
    level.mesh = in_level_units(mesh, tile.level);
    for (const Face& f : level.mesh.faces)
        if (!(signed_area2(level.mesh.position[f[0]], level.mesh.position[f[1]], level.mesh.position[f[2]]) >
              0))
            throw Error(ErrorKind::kInternal,
                        "a face of a coarser tile has no area on the grid of its level");
    Displacements rest;
    static_cast<GridSize&>(rest) = image.source;
    rest.dx.assign(rest.pixel_count(), 0);
    rest.dy = rest.dx;
    rest.inside = covered(level.mesh, image.source);
    image.source.has_mask = !rest.inside.empty();
    level.map = locate_map(level.mesh, rest, WeightPrecision::kFloat).map;
    return image;
}

}  // namespace imgmesh
