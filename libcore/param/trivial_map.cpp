#include "libcore/param/trivial_map.h"

#include "libcore/recon/raster.h"

namespace imgmesh {

PixelMap trivial_map(const BaseMesh& mesh, int width, int height) {
    return rasterize(mesh, sample_grid(width, height, 1));
}

}  // namespace imgmesh
