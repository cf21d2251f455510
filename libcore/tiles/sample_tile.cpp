#include "libcore/tiles/sample_tile.h"

#include <algorithm>
#include <cmath>

#include "libcore/mesh/grid_mesh.h"
#include "libcore/mesh/raster.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh {
namespace {

// The pixels of a level along `length` pixels of level 0.
std::vector<double> places(int length, int level) {
    std::vector<double> out;
    for (int i = 0; i <= (length - 1) >> level; ++i) out.push_back(std::ldexp(i, level));
    return out;
}

struct Drawing {
    FeatureImage feature;
    Mask mask;
};

Drawing draw_at(const BaseMesh& mesh, const SampleGrid& samples) {
    const PixelMap map = rasterize(mesh, samples);
    Drawing out{{map.width, map.height, mesh.channels, {}}, {map.width, map.height, {}}};
    for (const PixelCoord& at : map) {
        out.mask.values.push_back(at.face != kNone);
        for (int c = 0; c < mesh.channels; ++c) {
            float value = 0;
            if (at.face != kNone) {
                const Face& face = mesh.faces[at.face];
                const auto corner = [&](std::size_t k) { return mesh.feature_of(face[k])[c]; };
                value = (1 - at.u - at.v) * corner(0) + at.u * corner(1) + at.v * corner(2);
            }
            out.feature.data.push_back(value);
        }
    }
    return out;
}

std::vector<Id> pixels_on_sides(const Mask& mask) {
    std::vector<Id> pixels;
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x)
            if (mask.at(x, y) && (x == 0 || y == 0 || x == mask.width - 1 || y == mask.height - 1))
                pixels.push_back(as_id(mask.index(x, y)));
    return pixels;
}

}  // namespace

BaseMesh sampled_tile(std::span<const ChildTile> children, int level, int width, int height,
                      const SimplifyParams& params) {
    const BaseMesh joined = joined_children(children);
    Drawing drawing = draw_at(joined, {places(width, level), places(height, level)});
    if (drawing.mask.count() == 0) return {};
    GridMesh grid = grid_mesh(std::move(drawing.feature), std::move(drawing.mask));
    grid.side_vertices = pixels_on_sides(grid.mask);
    const auto goal = static_cast<std::int64_t>(joined.vertex_count() / 4);
    BaseMesh mesh = simplify(grid, params, {.vertices = std::max<std::int64_t>(4, goal)}).mesh;
    for (Vec2f& place : mesh.position) place *= std::ldexp(1.0f, level);
    return mesh;
}

}  // namespace imgmesh
