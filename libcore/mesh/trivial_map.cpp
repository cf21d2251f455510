#include "libcore/mesh/trivial_map.h"

#include "libcore/mesh/raster.h"

namespace imgmesh {

PixelMap trivial_map(const BaseMesh& mesh, int width, int height, const Mask& mask) {
    PixelMap map = rasterize(mesh, sample_grid(width, height, 1));
    if (mask.empty()) return map;
    for (std::size_t i = 0; i < map.size(); ++i)
        if (!mask.contains(i)) map[i] = {};
    return map;
}

}  // namespace imgmesh
