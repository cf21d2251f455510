#include "libcore/mesh/round_positions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "libcore/mesh/adjacency.h"
#include "libcore/mesh/fixed_axes.h"

namespace imgmesh {
namespace {

double squared_edges(const std::array<Vec2f, 3>& p) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += (p[(i + 1) % 3] - p[i]).cast<double>().squaredNorm();
    return sum;
}

class Rounding {
  public:
    Rounding(BaseMesh& mesh, float step, double min_quality, const GridSize* tile)
        : mesh_(mesh),
          step_(step),
          min_quality_(min_quality),
          fixed_(fixed_axes(mesh, tile)),
          corners_(vertex_corners(mesh.faces, mesh.vertex_count())) {
        for (const auto& [a, b, c] : mesh.faces)
            least_area2_.push_back(kLeastShare *
                                   signed_area2(mesh.position[a], mesh.position[b], mesh.position[c]));
    }

    bool is_round(Id v) const { return on_grid(mesh_.position[v].x()) && on_grid(mesh_.position[v].y()); }
    // Whether nothing is left to round: coordinates that stay do not count.
    bool is_done(Id v) const {
        return ((fixed_[v] & kFixedX) || on_grid(mesh_.position[v].x())) &&
               ((fixed_[v] & kFixedY) || on_grid(mesh_.position[v].y()));
    }

    // Moves a vertex that is not done. Returns whether there was a place for it.
    bool move(Id v) const {
        const Vec2f from = mesh_.position[v];
        std::array<Vec2f, 16> place;
        std::size_t count = 0;
        const Vec2f base(std::floor(from.x() / step_), std::floor(from.y() / step_));
        for (int dy = -1; dy <= 2; ++dy)
            for (int dx = -1; dx <= 2; ++dx) {
                Vec2f to = step_ * (base + Vec2f(static_cast<float>(dx), static_cast<float>(dy)));
                if (fixed_[v] & kFixedX) to.x() = from.x();
                if (fixed_[v] & kFixedY) to.y() = from.y();
                if (to != from) place[count++] = to;
            }
        const std::span<Vec2f> places = std::span(place).first(count);
        std::ranges::stable_sort(places, {},
                                 [&](const Vec2f& to) { return (to - from).cast<double>().squaredNorm(); });
        for (const Vec2f& to : places)
            if (keeps_faces(v, to)) {
                mesh_.position[v] = to;
                return true;
            }
        return false;
    }

  private:
    static constexpr double kLeastShare = 0.25;

    bool on_grid(float x) const { return x / step_ == std::floor(x / step_); }

    bool keeps_faces(Id v, const Vec2f& to) const {
        for (const std::size_t corner : corners_.of(v)) {
            const Face& face = mesh_.faces[corner / 3];
            std::array<Vec2f, 3> p = {mesh_.position[face[0]], mesh_.position[face[1]],
                                      mesh_.position[face[2]]};
            const double before = signed_area2(p[0], p[1], p[2]), edges = squared_edges(p);
            p[corner % 3] = to;
            const double after = signed_area2(p[0], p[1], p[2]);
            if (!(after > 0) || after < least_area2_[corner / 3]) return false;
            const double unit = 2 * std::sqrt(3.0), quality = unit * after / squared_edges(p);
            if (quality < min_quality_ && quality < unit * before / edges) return false;
        }
        return true;
    }

    BaseMesh& mesh_;
    float step_;
    double min_quality_;
    std::vector<std::uint8_t> fixed_;
    VertexCorners corners_;
    std::vector<double> least_area2_;  // of each face
};

}  // namespace

std::size_t round_positions(BaseMesh& mesh, float step, double min_quality, const GridSize* tile) {
    const Rounding rounding(mesh, step, min_quality, tile);
    std::vector<Id> left;
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        if (!rounding.is_done(v)) left.push_back(v);
    // A vertex may find a place once its neighbours have theirs.
    constexpr int kPasses = 4;
    for (int pass = 0; pass < kPasses; ++pass)
        if (std::erase_if(left, [&](Id v) { return rounding.move(v); }) == 0) break;
    std::size_t off = 0;
    for (Id v = 0; v < mesh.vertex_count(); ++v) off += !rounding.is_round(v);
    return off;
}

}  // namespace imgmesh
