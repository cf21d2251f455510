// What moves of vertices fold in a pixel map.
#pragma once

#include <array>
#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/grid_area.h"
#include "libcore/mesh/mapped_position.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// Compares positions for the vertices of a mesh with the mesh's own. Pixels lie on their faces with the same
/// weights in both. What is folded in the mesh itself does not count. All three must outlive it, and
/// `position` may change meanwhile.
class MoveFolds {
  public:
    MoveFolds(const BaseMesh& mesh, const PixelMap& map, const std::vector<Vec2f>& position)
        : mesh_(mesh), map_(map), position_(position) {}

    /// Whether the moves turn a face over.
    bool is_turned(const Face& face) const {
        const auto area = [&](const std::vector<Vec2f>& p) {
            return signed_area2(p[face[0]], p[face[1]], p[face[2]]);
        };
        return !(area(position_) > 0) && area(mesh_.position) > 0;
    }

    /// Calls visit(pixels) for each of the four triangles of the cell of 2 x 2 pixels from (x, y) on, on both
    /// diagonals as map_quality() takes them, that the moves fold. Triangles with a pixel outside the mask
    /// are left out.
    template <typename Visit>
    void of_cell(int x, int y, Visit&& visit) const {
        const std::array<const PixelCoord*, 4> cell = {&map_.at(x, y), &map_.at(x, y + 1),
                                                       &map_.at(x + 1, y + 1), &map_.at(x + 1, y)};
        for (std::size_t i = 0; i < 4; ++i) {
            const std::array<const PixelCoord*, 3> pixels = {cell[i], cell[(i + 1) % 4], cell[(i + 2) % 4]};
            bool inside = true;
            for (const PixelCoord* c : pixels) inside &= c->face != kNone;
            // Few triangles fold, so the first question is the rarer one.
            if (inside && !(area(pixels, position_) > 0) && area(pixels, mesh_.position) > 0) visit(pixels);
        }
    }

  private:
    double area(const std::array<const PixelCoord*, 3>& pixels, const std::vector<Vec2f>& position) const {
        const auto place = [&](std::size_t i) { return mapped_position(mesh_.faces, position, *pixels[i]); };
        return grid_area2(place(0), place(2), place(1));
    }

    const BaseMesh& mesh_;
    const PixelMap& map_;
    const std::vector<Vec2f>& position_;
};

}  // namespace imgmesh
