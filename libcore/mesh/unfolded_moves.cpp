#include "libcore/mesh/unfolded_moves.h"

#include "libcore/mesh/move_folds.h"

namespace imgmesh {
namespace {

class Moves {
  public:
    Moves(const BaseMesh& mesh, const PixelMap& map, std::vector<Vec2f>& position)
        : mesh_(mesh), map_(map), position_(position), folds_(mesh, map, position) {}

    // Returns whether a move was taken back.
    bool round() {
        bool changed = false;
        for (const Face& face : mesh_.faces)
            if (folds_.is_turned(face)) changed |= take_back(face);
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

    // Most cells lie on faces that stay.
    bool check_cell(int x, int y) {
        bool any = false;
        for (const int dy : {0, 1})
            for (const int dx : {0, 1}) {
                const Id face = map_.at(x + dx, y + dy).face;
                any |= face != kNone && is_moved(mesh_.faces[face]);
            }
        if (!any) return false;
        bool changed = false;
        folds_.of_cell(x, y, [&](const auto& pixels) {
            for (const PixelCoord* c : pixels) changed |= take_back(mesh_.faces[c->face]);
        });
        return changed;
    }

    const BaseMesh& mesh_;
    const PixelMap& map_;
    std::vector<Vec2f>& position_;
    MoveFolds folds_;
};

}  // namespace

void take_back_folds(const BaseMesh& mesh, const PixelMap& map, std::vector<Vec2f>& position) {
    Moves moves(mesh, map, position);
    while (moves.round()) {
    }
}

}  // namespace imgmesh
