// Whole mesh images for tests of drawings.
#pragma once

#include <algorithm>
#include <random>

#include "libcore/image/color.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/mesh/trivial_map.h"
#include "tests/support/meshes.h"

namespace imgmesh::test {

/// A one-level MeshImage with its trivial map and random colours inside sRGB.
inline MeshImage grid_mesh_image(int width, int height, int columns, int rows, std::uint32_t seed) {
    MeshImage m;
    m.source.width = width;
    m.source.height = height;
    m.levels.resize(1);
    BaseMesh& mesh = m.levels[0].mesh;
    mesh = jittered_grid(0, 0, width - 1, height - 1, columns, rows, seed);
    std::mt19937 random(seed);
    const auto sample = [&] { return static_cast<float>(random() % 1000) / 999.0f; };
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3f luv = luv_from_linear({sample(), sample(), sample()});
        std::copy(luv.data(), luv.data() + 3, mesh.feature_of(v));
    }
    m.levels[0].map = trivial_map(mesh, width, height);
    return m;
}

}  // namespace imgmesh::test
