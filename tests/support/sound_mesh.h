// What must hold for every base mesh of a rectangle.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "libcore/metrics/metrics.h"

namespace imgmesh::test {

struct Size {
    int width, height;
};

inline bool has_vertex(const BaseMesh& mesh, float x, float y) {
    return std::any_of(mesh.position.begin(), mesh.position.end(),
                       [&](const Vec2f& p) { return p.x() == x && p.y() == y; });
}

/// A triangulation of the image's rectangle on the position grid. (Areas on that grid are exact.)
inline void check_sound(const BaseMesh& mesh, Size size) {
    const MeshQuality q = mesh_quality(mesh);
    CHECK(q.nonmanifold_edges == 0);
    CHECK(q.nonmanifold_vertices == 0);
    CHECK(q.components == 1);
    CHECK(q.euler == 1);
    CHECK(q.flipped_faces == 0);
    const float left = size.width == 1 ? -0.5f : 0,
                right = size.width == 1 ? 0.5f : static_cast<float>(size.width - 1);
    const float top = size.height == 1 ? -0.5f : 0,
                bottom = size.height == 1 ? 0.5f : static_cast<float>(size.height - 1);
    CHECK(q.area == double(right - left) * double(bottom - top));
    for (const float x : {left, right})
        for (const float y : {top, bottom}) CHECK(has_vertex(mesh, x, y));
    for (const Vec2f& p : mesh.position) {
        CHECK(std::remainder(p.x(), kPositionStep) == 0);
        CHECK(std::remainder(p.y(), kPositionStep) == 0);
    }
    CHECK(mesh.feature.size() == 3 * mesh.vertex_count());
    CHECK(std::all_of(mesh.feature.begin(), mesh.feature.end(), [](float f) { return std::isfinite(f); }));
}

}  // namespace imgmesh::test
