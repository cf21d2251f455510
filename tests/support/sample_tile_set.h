// A small tile set of a picture that is a formula, made without imgmesh-build.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "formats/container/container.h"
#include "formats/tileset/tile_set_files.h"
#include "formats/tileset/tile_view.h"
#include "formats/tileset/tileset_json.h"
#include "libcore/image/color.h"
#include "libcore/mesh/locate_map.h"
#include "libcore/tiles/tile_units.h"

namespace imgmesh::test {

/// The picture's colour at a place, as a container stores it.
inline Vec3f sample_color(double x, double y) {
    const auto wave = [](double t) { return static_cast<float>(0.5 + 0.4 * std::sin(t)); };
    return quantized_color(luv_from_linear({wave(0.05 * x), wave(0.04 * y), wave(0.03 * (x + y))}));
}

/// The mesh of a tile in pixels of level 0: two faces for each cell of 8 units, of which the last ones may be
/// smaller.
inline BaseMesh sample_mesh(const TileGrid& grid, const TileName& tile) {
    const PixelRect rect = grid.rect(tile);
    const int cell = 8 << tile.level;
    const auto places = [&](int pixels) {
        std::vector<int> out;
        for (int at = 0; at < pixels - 1; at += cell) out.push_back(at);
        out.push_back(pixels - 1);
        return out;
    };
    const std::vector<int> xs = places(rect.width()), ys = places(rect.height());
    BaseMesh mesh;
    for (const int y : ys)
        for (const int x : xs) {
            mesh.position.emplace_back(static_cast<float>(x), static_cast<float>(y));
            const Vec3f color = sample_color(rect.left + x, rect.top + y);
            mesh.feature.insert(mesh.feature.end(), color.data(), color.data() + 3);
        }
    const auto row = static_cast<Id>(xs.size());
    for (Id j = 0; j + 1 < ys.size(); ++j)
        for (Id i = 0; i + 1 < row; ++i) {
            const Id a = j * row + i, b = a + 1, c = a + row, d = c + 1;
            mesh.faces.push_back({a, c, d});
            mesh.faces.push_back({a, d, b});
        }
    return mesh;
}

/// The tile as a container holds it.
inline MeshImage sample_tile(const TileGrid& grid, const TileName& tile) {
    MeshImage image = coarse_image(sample_mesh(grid, tile), SourceInfo(), grid, tile);
    image.generator = "imgmesh-build 0.1.0";
    return image;
}

/// Writes the files of a tile and its record.
inline TileRecord write_sample_tile(const std::string& folder, const TileSetPlan& plan, const TileName& tile,
                                    const MeshImage& image) {
    make_level_folders(folder, tile.level);
    ContainerOptions options;
    options.layers = LayerLayout::kCompact;
    write_container(in_set(folder, tile_container(tile)), image, options);
    const BaseMesh& mesh = image.levels[0].mesh;
    write_tile_view(mesh, image.source, plan.grid(), tile, image.generator, in_set(folder, tile_view(tile)));
    TileRecord record{tile, plan_key(plan), {}};
    record.files = {file_facts(folder, tile_container(tile)), file_facts(folder, tile_view(tile))};
    record.vertices = static_cast<std::int64_t>(mesh.vertex_count());
    const PixelRect rect = plan.grid().rect(tile);
    const TileGrid grid = plan.grid();
    for (const Vec2f& p : in_pixels(mesh, tile.level).position)
        if ((p.x() < static_cast<float>(rect.width() - 1) || rect.right == grid.width()) &&
            (p.y() < static_cast<float>(rect.height() - 1) || rect.bottom == grid.height()))
            ++record.own_vertices;
    record.faces = static_cast<std::int64_t>(mesh.faces.size());
    if (tile.level == 0) {
        const PixelRect own = plan.grid().own_rect(tile);
        record.pixels = std::int64_t{own.width()} * own.height();
    }
    write_record(folder, record);
    return record;
}

/// Writes a whole set, and returns its index.
inline TileSetIndex write_sample_set(const std::string& folder, int width, int height, int tile) {
    TileSetIndex index;
    index.plan = {"imgmesh-build 0.1.0", {"a formula", 0, ""}, width, height, tile, {}, 1.5, 0.25};
    index.threshold = 0.25;
    const TileGrid grid = index.plan.grid();
    for (int level = 0; level < grid.levels(); ++level)
        for (const TileName& name : grid.tiles(level))
            index.tiles.push_back(write_sample_tile(folder, index.plan, name, sample_tile(grid, name)));
    write_plan(folder, index.plan);
    write_tileset(folder, index);
    write_index(folder, index);
    return index;
}

}  // namespace imgmesh::test
