#include "libcore/mesh/stretch.h"

#include <algorithm>
#include <limits>

#include "libcore/mesh/adjacency.h"
#include "libcore/mesh/move_folds.h"

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
        : mesh_(mesh),
          map_(map),
          position_(position),
          folds_(mesh, map, position),
          sides_(box_of(position)) {}

    // Returns whether nothing is folded any more.
    bool mend() {
        std::vector<Id> near = near_folds();
        if (near.empty()) return true;
        corners_ = vertex_corners(mesh_.faces, mesh_.vertex_count());
        pixels_of_faces();
        constexpr int kMostRounds = 16;
        for (int round = 0; round < kMostRounds; ++round) {
            bool changed = false;
            for (const Id v : near) changed |= improve(v);
            if (!changed) return false;
            near = near_folds();
            if (near.empty()) return true;
        }
        return false;
    }

  private:
    // The vertices of all faces that have turned over or hold a pixel of a fold, in order.
    std::vector<Id> near_folds() const {
        std::vector<Id> out;
        const auto add = [&](const Face& face) { out.insert(out.end(), face.begin(), face.end()); };
        for (const Face& face : mesh_.faces)
            if (folds_.is_turned(face)) add(face);
        for (int y = 0; y + 1 < map_.height; ++y)
            for (int x = 0; x + 1 < map_.width; ++x)
                folds_.of_cell(x, y, [&](const auto& pixels) {
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
            folds += folds_.is_turned(mesh_.faces[corner / 3]);
            box.add(pixels_[corner / 3]);
        }
        for (int y = std::max(box.top - 1, 0); y <= std::min(box.bottom, map_.height - 2); ++y)
            for (int x = std::max(box.left - 1, 0); x <= std::min(box.right, map_.width - 2); ++x)
                folds_.of_cell(x, y, [&](const auto&) { ++folds; });
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
    MoveFolds folds_;
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
