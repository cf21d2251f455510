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

PixelMap cover_of(const Level& level) {
    check_cover(level.mesh, sample_grid(level.map.width, level.map.height, 1));
    return trivial_map(level.mesh, level.map.width, level.map.height);
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

PixelMap map_by_place(const Level& level) {
    const PixelMap cover = cover_of(level);
    PixelMap map = cover;
    for (std::size_t i = 0; i < map.pixel_count(); ++i)
        if (map[i].face == kNone && level.map[i].face != kNone)
            map[i] = coord_near(level.mesh, cover,
                                {static_cast<float>(map.x_of(i)), static_cast<float>(map.y_of(i))});
    return map;
}

}  // namespace imgmesh
