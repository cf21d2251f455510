#include "libcore/tiles/tile_units.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <vector>

#include "libcore/base/error.h"
#include "libcore/mesh/locate_map.h"
#include "libcore/mesh/trivial_map.h"

namespace imgmesh {
namespace {

// The pixels that lie on a face; empty() for all.
Mask covered(const BaseMesh& mesh, const GridSize& size) {
    const PixelMap map = trivial_map(mesh, size.width, size.height);
    if (std::ranges::none_of(map, [](const PixelCoord& c) { return c.face == kNone; })) return {};
    Mask mask{size.width, size.height, {}};
    for (const PixelCoord& c : map) mask.values.push_back(c.face != kNone);
    return mask;
}

Vec2f nearest(const Vec2f& p) {
    return {snapped(p.x()), snapped(p.y())};
}

// Moves vertices to the grid of positions. Most go to the nearest point; where a face would lose its area, as
// a thin one may, its vertex takes another point close by.
class GridPlaces {
  public:
    explicit GridPlaces(BaseMesh& mesh) : mesh_(mesh), first_(mesh.vertex_count() + 1) {
        for (const Face& f : mesh.faces)
            for (const Id v : f) ++first_[v + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        faces_.resize(3 * mesh.faces.size());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (Id f = 0; f < mesh.faces.size(); ++f)
            for (const Id v : mesh.faces[f]) faces_[next[v]++] = f;
    }

    // Vertices that are `fixed` stay. One that has no fitting point stays where it is.
    void settle(const std::vector<bool>& fixed) {
        for (Id v = 0; v < mesh_.vertex_count(); ++v)
            if (!fixed[v] && (mesh_.position[v] != nearest(mesh_.position[v]) || !fits(v))) move(v);
    }

  private:
    bool fits(Id v) const {
        for (std::size_t i = first_[v]; i < first_[v + 1]; ++i) {
            const Face& f = mesh_.faces[faces_[i]];
            if (!(signed_area2(mesh_.position[f[0]], mesh_.position[f[1]], mesh_.position[f[2]]) > 0))
                return false;
        }
        return true;
    }

    void move(Id v) {
        constexpr int kReach = 8;  // steps: as far as thin faces have ever needed, and less than a pixel
        const Vec2f own = mesh_.position[v], middle = nearest(own);
        std::optional<Vec2f> best;
        float least = 0;
        for (int reach = 0; reach <= kReach && !best; ++reach)
            for (int dy = -reach; dy <= reach; ++dy)
                for (int dx = -reach; dx <= reach; ++dx) {
                    if (std::max(std::abs(dx), std::abs(dy)) != reach) continue;
                    const Vec2f place = middle + kPositionStep * Vec2f(float(dx), float(dy));
                    const float distance = (place - own).squaredNorm();
                    if (best && distance >= least) continue;
                    mesh_.position[v] = place;
                    if (!fits(v)) continue;
                    best = place;
                    least = distance;
                }
        mesh_.position[v] = best.value_or(own);
    }

    BaseMesh& mesh_;
    std::vector<std::size_t> first_;  // of the vertices in faces_
    std::vector<Id> faces_;
};

}  // namespace

BaseMesh in_level_units(BaseMesh mesh, int level) {
    const float unit = std::ldexp(1.0f, level);
    for (Vec2f& p : mesh.position) p /= unit;
    const Vec2f corner =
        std::accumulate(mesh.position.begin(), mesh.position.end(), Vec2f(0, 0),
                        [](const Vec2f& most, const Vec2f& p) { return Vec2f(most.cwiseMax(p)); });
    std::vector<bool> fixed(mesh.vertex_count());
    for (Id v = 0; v < fixed.size(); ++v) {
        Vec2f& p = mesh.position[v];
        fixed[v] = p.x() == 0 || p.y() == 0 || p.x() == corner.x() || p.y() == corner.y();
        if (fixed[v]) p = nearest(p);
    }
    GridPlaces(mesh).settle(fixed);
    return mesh;
}

BaseMesh in_pixels(BaseMesh mesh, int level) {
    const float unit = std::ldexp(1.0f, level);
    for (Vec2f& p : mesh.position) p *= unit;
    return mesh;
}

MeshImage coarse_image(const BaseMesh& mesh, const SourceInfo& source, const TileGrid& grid,
                       const TileName& tile) {
    MeshImage image;
    image.source = source;
    static_cast<GridSize&>(image.source) = level_size(grid, tile);
    Level& level = image.levels.emplace_back();
    level.mesh = in_level_units(mesh, tile.level);
    for (const Face& f : level.mesh.faces) {
        const auto corner = [&](std::size_t i) { return level.mesh.position[f[i]]; };
        if (!(signed_area2(corner(0), corner(1), corner(2)) > 0))
            throw Error(ErrorKind::kInternal, cat("tile of level ", tile.level, ", column ", tile.column,
                                                  ", row ", tile.row, ": a face at (", corner(0).x(), ",",
                                                  corner(0).y(), ") has no area on the grid of its level"));
    }
    Displacements rest;
    static_cast<GridSize&>(rest) = image.source;
    rest.dx.assign(rest.pixel_count(), 0);
    rest.dy = rest.dx;
    rest.inside = covered(level.mesh, image.source);
    image.source.has_mask = !rest.inside.empty();
    level.map = locate_map(level.mesh, rest, WeightPrecision::kFloat).map;
    return image;
}

}  // namespace imgmesh
