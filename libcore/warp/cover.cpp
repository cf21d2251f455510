#include "libcore/warp/cover.h"

#include <algorithm>
#include <cmath>

#include "libcore/mesh/bounded_raster.h"
#include "libcore/mesh/trivial_map.h"

namespace imgmesh {
namespace {

// Returns the pixel with a face nearest to a point, searched in growing squares; of equal ones the first.
std::size_t nearest_pixel(const PixelMap& map, const Vec2f& p) {
    const int cx = std::clamp(as_int(std::lround(p.x())), 0, map.width - 1),
              cy = std::clamp(as_int(std::lround(p.y())), 0, map.height - 1);
    std::size_t best = 0;
    float least = INFINITY;
    for (int r = 0; r <= std::max(map.width, map.height) && least == INFINITY; ++r)
        for (int y = std::max(cy - r, 0); y <= std::min(cy + r, map.height - 1); ++y)
            for (int x = std::max(cx - r, 0); x <= std::min(cx + r, map.width - 1); ++x) {
                const std::size_t i = map.index(x, y);
                const float distance = (Vec2f(static_cast<float>(x), static_cast<float>(y)) - p).norm();
                if (map[i].face == kNone || distance >= least) continue;
                least = distance;
                best = i;
            }
    return best;
}

}  // namespace

PixelMap cover_of(const BaseMesh& mesh, const GridSize& size) {
    check_cover(mesh, sample_grid(size.width, size.height, 1));
    return trivial_map(mesh, size.width, size.height);
}

PixelCoord coord_near(const BaseMesh& mesh, const PixelMap& cover, const Vec2f& at) {
    const Id face = cover[nearest_pixel(cover, at)].face;
    if (face == kNone) return {};
    const auto [ia, ib, ic] = mesh.faces[face];
    const Vec2f &pa = mesh.position[ia], &pb = mesh.position[ib], &pc = mesh.position[ic];
    const double area = signed_area2(pa, pb, pc);
    return {face, static_cast<float>(signed_area2(at, pc, pa) / area),
            static_cast<float>(signed_area2(at, pa, pb) / area)};
}

PixelMap map_by_place(const BaseMesh& mesh, const PixelMap& map) {
    const PixelMap cover = cover_of(mesh, map);
    PixelMap complete = cover;
    for (std::size_t i = 0; i < map.pixel_count(); ++i)
        if (cover[i].face == kNone && map[i].face != kNone)
            complete[i] =
                coord_near(mesh, cover, {static_cast<float>(map.x_of(i)), static_cast<float>(map.y_of(i))});
    return complete;
}

void add_moves_at(const Level& level, const VertexMoves& moves, const std::vector<Vec2f>& at,
                  std::vector<Vec2f>& sum) {
    const PixelMap cover = cover_of(level.mesh, level.map);
    for (std::size_t i = 0; i < at.size(); ++i) {
        const PixelCoord c = coord_near(level.mesh, cover, at[i]);
        if (c.face == kNone) continue;
        const auto [ia, ib, ic] = level.mesh.faces[c.face];
        sum[i] += moves[ia] + c.u * (moves[ib] - moves[ia]) + c.v * (moves[ic] - moves[ia]);
    }
}

}  // namespace imgmesh
