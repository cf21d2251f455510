// Meshes for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh::test {

/// A rectangle [left, right] x [top, bottom] cut into columns x rows cells of two triangles each, with inner
/// vertices moved at random on the kPositionStep grid and random diagonals; features zero. Every face
/// is positive. Needs cells of at least a pixel.
inline BaseMesh jittered_grid(double left, double top, double right, double bottom, int columns, int rows,
                              std::uint32_t seed) {
    std::mt19937 random(seed);
    BaseMesh mesh;
    const auto place = [&](double low, double high, int i, int n) {
        // A quarter of a cell in any direction keeps both triangles of every cell positive, with either
        // diagonal.
        const double jitter = i == 0 || i == n ? 0 : (double(random() % 1001) / 1000 - 0.5) * 0.45;
        const double at = low + (high - low) * (i + jitter) / n;
        return static_cast<float>(std::clamp(std::floor(at / kPositionStep) * kPositionStep, low, high));
    };
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i)
            mesh.position.push_back({place(left, right, i, columns), place(top, bottom, j, rows)});
    mesh.feature.assign(mesh.position.size() * 3, 0.0f);
    const auto id = [&](int i, int j) { return static_cast<Id>(j * (columns + 1) + i); };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const Id a = id(i, j), b = id(i + 1, j), c = id(i, j + 1), d = id(i + 1, j + 1);
            if (random() % 2 == 0) {
                mesh.faces.push_back({a, c, d});
                mesh.faces.push_back({a, d, b});
            } else {
                mesh.faces.push_back({a, c, b});
                mesh.faces.push_back({b, c, d});
            }
        }
    std::shuffle(mesh.faces.begin(), mesh.faces.end(), random);
    return mesh;
}

}  // namespace imgmesh::test
