#include "libcore/mesh/bounded_raster.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"

namespace imgmesh {

void check_cover(const BaseMesh& mesh, const SampleGrid& grid, double free) {
    constexpr double kMostCovers = 64;
    const double samples = static_cast<double>(grid.x.size()) * static_cast<double>(grid.y.size());
    double work = 0;
    for (const auto& [ia, ib, ic] : mesh.faces) {
        const Vec2f &a = mesh.position[ia], &b = mesh.position[ib], &c = mesh.position[ic];
        const double height = std::max({a.y(), b.y(), c.y()}) - std::min({a.y(), b.y(), c.y()});
        work += std::abs(signed_area2(a, b, c)) / 2 * grid.scale * grid.scale + height * grid.scale;
    }
    if (!(work <= kMostCovers * samples + free))
        throw Error(ErrorKind::kUnsupported,
                    cat("the faces cover the image ", std::floor(work / samples), " times over, at most ",
                        kMostCovers, " times can be drawn"));
}

PixelMap bounded_raster(const BaseMesh& mesh, const SampleGrid& grid) {
    constexpr double kFree = 1 << 20;
    check_cover(mesh, grid, kFree);
    return rasterize(mesh, grid);
}

}  // namespace imgmesh
