// Mesh images, moves and images for tests of warping.
#pragma once

#include <cmath>
#include <functional>
#include <random>

#include "libcore/mesh/mesh_image.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/warp/displacement.h"
#include "tests/support/meshes.h"

namespace imgmesh::test {

/// A pyramid of jittered grids with trivial maps; cells_of[k] cells a side at level k.
inline MeshImage grid_pyramid(int width, int height, const std::vector<int>& cells_of) {
    MeshImage m;
    m.source.width = width;
    m.source.height = height;
    for (const int cells : cells_of) {
        Level level;
        const float left = width == 1 ? -0.5f : 0, top = height == 1 ? -0.5f : 0;
        level.mesh = jittered_grid(double(left), double(top), double(width == 1 ? 0.5f : float(width - 1)),
                                   double(height == 1 ? 0.5f : float(height - 1)), width == 1 ? 1 : cells,
                                   height == 1 ? 1 : cells, static_cast<std::uint32_t>(cells));
        level.map = trivial_map(level.mesh, width, height);
        m.levels.push_back(std::move(level));
    }
    return m;
}

/// Cuts out the pixels for which `inside` holds, on all levels.
inline void apply_mask(MeshImage& m, const std::function<bool(int x, int y)>& inside) {
    m.source.has_mask = true;
    for (Level& level : m.levels)
        for (int y = 0; y < level.map.height; ++y)
            for (int x = 0; x < level.map.width; ++x)
                if (!inside(x, y)) level.map.row(y)[static_cast<std::size_t>(x)] = {};
}

/// The field of an image without a mask, each pixel moved by move(x, y).
inline DisplacementField field_of(int width, int height, const std::function<Vec2f(int x, int y)>& move) {
    DisplacementField field;
    field.width = width;
    field.height = height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) field.move.push_back(move(x, y));
    field.role.assign(field.move.size(), PixelRole::kInside);
    return field;
}

/// Independent samples from -1 to 2; integer images can hold a third of them.
inline Image noise_image(int width, int height, int channels, std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    Image image = make_image(width, height, channels);
    for (float& sample : image.data) sample = static_cast<float>(random() % 3001) / 1000 - 1;
    return image;
}

}  // namespace imgmesh::test
