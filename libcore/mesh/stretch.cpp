#include "libcore/mesh/stretch.h"

#include <algorithm>
#include <array>
#include <limits>

#include "libcore/mesh/adjacency.h"
#include "libcore/mesh/grid_area.h"
#include "libcore/mesh/mapped_position.h"

namespace imgmesh {
namespace {

struct Box {
    Vec2f low = Vec2f::Constant(std::numeric_limits<float>::infinity());
    Vec2f high = Vec2f::Constant(-std::numeric_limits<float>::infinity());
};

Box box_of(const std::vector<Vec2f>& position) {
    Box box;
    for (const Vec2f& p : position) {
        box.low = box.low.cwiseMin(p);
        box.high = box.high.cwiseMax(p);
    }
    return box;
}

bool is_between_centres_and_sides(const Box& box, int width, int height) {
    const Vec2f last(static_cast<float>(width - 1), static_cast<float>(height - 1));
    for (int i = 0; i < 2; ++i)
        if (box.low[i] > 0 || box.low[i] < -0.5f || box.high[i] < last[i] || box.high[i] > last[i] + 0.5f ||
            !(box.low[i] < box.high[i]))
            return false;
    return true;
}

// Pixels of a face, and of a vertex' faces.
struct PixelBox {
    int left = std::numeric_limits<int>::max(), top = left, right = -1, bottom = -1;

    void add(const PixelBox& other) {
        left = std::min(left, other.left);
        top = std::min(top, other.top);
        right = std::max(right, other.right);
        bottom = std::max(bottom, other.bottom);
    }
};

// Mends the folds that rounding has made.
class Mender {
  public:
    Mender(const BaseMesh& mesh, const PixelMap& map, std::vector<Vec2f>& position)
        : mesh_(mesh), map_(map), position_(position), sides_(box_of(position)) {}

    // Returns whether nothing is folded any more.
    bool mend() {
        if (const std::vector<Id> first = near_folds(); first.empty()) return true;
        corners_ = vertex_corners(mesh_.faces, mesh_.vertex_count());
        pixels_of_faces();
        constexpr int kMostRounds = 16;
        for (int round = 0; round < kMostRounds; ++round) {
            bool changed = false;
            for (const Id v : near_folds()) changed |= improve(v);
            if (near_folds().empty()) return true;
            if (!changed) return false;
        }
        return false;
    }

  private:
    bool is_turned(const Face& face) const {
        const auto [a, b, c] = face;
        return signed_area2(mesh_.position[a], mesh_.position[b], mesh_.position[c]) > 0 &&
               !(signed_area2(position_[a], position_[b], position_[c]) > 0);
    }

    // Calls visit(pixels) for each triangle of the cell of 2 x 2 pixels, on both diagonals, that has folded.
    template <typename Visit>
    void folds_of_cell(int x, int y, Visit&& visit) const {
        const std::array<const PixelCoord*, 4> cell = {&map_.at(x, y), &map_.at(x, y + 1),
                                                       &map_.at(x + 1, y + 1), &map_.at(x + 1, y)};
        for (const PixelCoord* c : cell)
            if (c->face == kNone) return;  // in the image of a whole mesh there are none
        std::array<Vec2d, 4> before, after;
        for (std::size_t i = 0; i < 4; ++i) {
            before[i] = mapped_position(mesh_.faces, mesh_.position, *cell[i]);
            after[i] = mapped_position(mesh_.faces, position_, *cell[i]);
        }
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t j = (i + 1) % 4, k = (i + 2) % 4;
            if (grid_area2(before[i], before[k], before[j]) > 0 &&
                !(grid_area2(after[i], after[k], after[j]) > 0))
                visit(std::array{cell[i], cell[j], cell[k]});
        }
    }

    // The vertices of all faces that have turned over or hold a pixel of a fold, in order.
    std::vector<Id> near_folds() const {
        std::vector<Id> out;
        const auto add = [&](const Face& face) { out.insert(out.end(), face.begin(), face.end()); };
        for (const Face& face : mesh_.faces)
            if (is_turned(face)) add(face);
        for (int y = 0; y + 1 < map_.height; ++y)
            for (int x = 0; x + 1 < map_.width; ++x)
                folds_of_cell(x, y, [&](const std::array<const PixelCoord*, 3>& pixels) {
                    for (const PixelCoord* c : pixels) add(mesh_.faces[c->face]);
                });
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
        return out;
    }

    void pixels_of_faces() {
        pixels_.resize(mesh_.faces.size());
        for (int y = 0; y < map_.height; ++y)
            for (int x = 0; x < map_.width; ++x)
                if (const Id face = map_.at(x, y).face; face != kNone) pixels_[face].add({x, y, x, y});
    }

    int folds_around(Id v) const {
        int folds = 0;
        PixelBox box;
        for (const std::size_t corner : corners_.of(v)) {
            folds += is_turned(mesh_.faces[corner / 3]);
            box.add(pixels_[corner / 3]);
        }
        for (int y = std::max(box.top - 1, 0); y <= std::min(box.bottom, map_.height - 2); ++y)
            for (int x = std::max(box.left - 1, 0); x <= std::min(box.right, map_.width - 2); ++x)
                folds_of_cell(x, y, [&](const auto&) { ++folds; });
        return folds;
    }

    // Moves a vertex by a step if less is folded then. Those on the sides stay there.
    bool improve(Id v) {
        const Vec2f from = position_[v];
        Vec2f best = from;
        int least = folds_around(v);
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const Vec2f to = from + kPositionStep * Vec2f(static_cast<float>(dx), static_cast<float>(dy));
                bool stays = true;
                for (int i = 0; i < 2; ++i)
                    stays &= to[i] == from[i] || (from[i] > sides_.low[i] && from[i] < sides_.high[i]);
                if (!stays) continue;
                position_[v] = to;
                if (const int folds = folds_around(v); folds < least) {
                    least = folds;
                    best = to;
                }
            }
        position_[v] = best;
        return best != from;
    }

    const BaseMesh& mesh_;
    const PixelMap& map_;
    std::vector<Vec2f>& position_;
    Box sides_;
    VertexCorners corners_;
    std::vector<PixelBox> pixels_;
};

}  // namespace

std::optional<std::vector<Vec2f>> stretched_positions(const BaseMesh& mesh, const PixelMap& map) {
    const Box box = box_of(mesh.position);
    if (!is_between_centres_and_sides(box, map.width, map.height)) return std::nullopt;
    const Vec2f scale = Vec2f(static_cast<float>(map.width), static_cast<float>(map.height))
                            .cwiseQuotient(box.high - box.low);
    std::vector<Vec2f> position;
    position.reserve(mesh.position.size());
    for (const Vec2f& p : mesh.position) {
        const Vec2f to = (p - box.low).cwiseProduct(scale) - Vec2f::Constant(0.5f);
        position.emplace_back(snapped(to.x()), snapped(to.y()));
    }
    if (!Mender(mesh, map, position).mend()) return std::nullopt;
    return position;
}

}  // namespace imgmesh
