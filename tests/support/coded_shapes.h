// Meshes on a grid for tests of coded pictures.
#pragma once

#include <algorithm>
#include <random>
#include <vector>

#include "libcore/base/index.h"
#include "libcore/coding/draw_coded.h"

namespace imgmesh {

/// Lines of the grid that cross everywhere, so that faces are of any size and cover it; each cell has one of
/// its diagonals.
struct CrossedLines {
    CodedGrid grid;
    std::vector<GridPoint> point;
    std::vector<Face> faces;

    CrossedLines(const CodedGrid& on, int lines, std::mt19937& random) : grid(on) {
        const std::vector<int> x = pick(grid.columns(), lines, random), y = pick(grid.rows(), lines, random);
        for (const int row : y)
            for (const int column : x) point.push_back({column, row});
        const Id across = as_id(x.size());
        for (Id j = 0; j + 1 < y.size(); ++j)
            for (Id i = 0; i + 1 < across; ++i) {
                const Id a = j * across + i, b = a + 1, c = a + across, d = c + 1;
                if (random() % 2 == 0) {
                    faces.push_back({a, b, d});
                    faces.push_back({a, d, c});
                } else {
                    faces.push_back({a, b, c});
                    faces.push_back({b, d, c});
                }
            }
    }
    coding::CodedShape shape() const { return {grid, point, faces}; }

  private:
    static std::vector<int> pick(int count, int lines, std::mt19937& random) {
        std::vector<int> out{0, count - 1};
        for (int i = 2; i < lines; ++i) out.push_back(static_cast<int>(random() % as_index(count)));
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
        return out;
    }
};

}  // namespace imgmesh
