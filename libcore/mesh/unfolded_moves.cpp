#include "libcore/mesh/unfolded_moves.h"

#include <array>

#include "libcore/mesh/grid_area.h"
#include "libcore/mesh/mapped_position.h"

namespace imgmesh {
namespace {

class Moves {
  public:
    Moves(const BaseMesh& mesh, const PixelMap& map, std::vector<Vec2f>& position)
        : mesh_(mesh), map_(map), position_(position) {}

    // Returns whether a move was taken back.
    bool round() {
        bool changed = false;
        for (const Face& face : mesh_.faces)
            if (is_moved(face) && area(face, mesh_.position) > 0 && area(face, position_) <= 0)
                changed |= take_back(face);
        for (int y = 0; y + 1 < map_.height; ++y)
            for (int x = 0; x + 1 < map_.width; ++x) changed |= check_cell(x, y);
        return changed;
    }

  private:
    bool is_moved(const Face& face) const {
        for (const Id v : face)
            if (position_[v] != mesh_.position[v]) return true;
        return false;
    }

    bool take_back(const Face& face) {
        bool changed = false;
        for (const Id v : face) {
            changed |= position_[v] != mesh_.position[v];
            position_[v] = mesh_.position[v];
        }
        return changed;
    }

    // As is usual for faces: positive where it runs counter-clockwise on screen.
    static double area(const Face& face, const std::vector<Vec2f>& position) {
        return -grid_area2(position[face[0]].cast<double>(), position[face[1]].cast<double>(),
                           position[face[2]].cast<double>());
    }

    // Checks the four triangles of a cell of 2 x 2 pixels, on both diagonals, as map_quality() does.
    bool check_cell(int x, int y) {
        const std::array<const PixelCoord*, 4> corners = {&map_.at(x, y), &map_.at(x, y + 1),
                                                          &map_.at(x + 1, y + 1), &map_.at(x + 1, y)};
        bool any = false;
        for (const PixelCoord* c : corners) any |= c->face != kNone && is_moved(mesh_.faces[c->face]);
        if (!any) return false;
        bool changed = false;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::array<const PixelCoord*, 3> pixels = {corners[i], corners[(i + 1) % 4],
                                                             corners[(i + 2) % 4]};
            bool inside = true;
            for (const PixelCoord* c : pixels) inside &= c->face != kNone;
            if (!inside || area_of(pixels, mesh_.position) <= 0 || area_of(pixels, position_) > 0) continue;
            for (const PixelCoord* c : pixels) changed |= take_back(mesh_.faces[c->face]);
        }
        return changed;
    }

    double area_of(const std::array<const PixelCoord*, 3>& pixels, const std::vector<Vec2f>& position) const {
        const auto place = [&](std::size_t i) { return mapped_position(mesh_.faces, position, *pixels[i]); };
        return grid_area2(place(0), place(2), place(1));
    }

    const BaseMesh& mesh_;
    const PixelMap& map_;
    std::vector<Vec2f>& position_;
};

}  // namespace

void take_back_folds(const BaseMesh& mesh, const PixelMap& map, std::vector<Vec2f>& position) {
    Moves moves(mesh, map, position);
    while (moves.round()) {
    }
}

}  // namespace imgmesh
