#include "libcore/tiles/error_density.h"

#include <algorithm>

#include "libcore/mesh/grid_mesh.h"
#include "libcore/pipeline/run_build.h"
#include "libcore/simplify/simplify.h"
#include "libcore/tiles/density.h"

namespace imgmesh {
namespace {

constexpr int kPartSide = 128;                   // [pixels]
constexpr std::size_t kShare = 32;               // of the pixels, one is looked at
constexpr double kStepX = 0.755, kStepY = 0.57;  // windows lie where such sequences are even

Image window_at(const Image& image, int left, int top) {
    Image out{{kPartSide, kPartSide, image.channels, {}},
              image.channel_names,
              image.sample_type,
              image.color_space};
    for (int y = top; y < top + kPartSide; ++y)
        out.data.insert(out.data.end(), image.pixel(left, y), image.pixel(left, y) + out.row_size());
    return out;
}

int place(int index, double step, int room) {
    const double share = (index + 0.5) * step;
    return static_cast<int>((share - static_cast<int>(share)) * room);
}

}  // namespace

double error_density(const Image& image, const BuildParams& params, const TileCommon& common) {
    const BuildParams scaled = in_features(params, static_cast<double>(common.space.unit));
    SimplifyTarget target;
    target.max_error = *scaled.stop.error / scaled.color_weight;
    const SimplifyParams collapse = tile_collapse(params, common);
    const std::size_t pixels = as_index(kPartSide) * as_index(kPartSide);
    const int count = std::max(1, as_int(image.pixel_count() / kShare / pixels));
    std::size_t vertices = 0;
    for (int n = 0; n < count; ++n) {
        const Image window = window_at(image, place(n, kStepX, image.width - kPartSide),
                                       place(n, kStepY, image.height - kPartSide));
        vertices += simplify(grid_mesh(tile_features(window, common)), collapse, target).mesh.vertex_count();
    }
    return static_cast<double>(vertices) / (static_cast<double>(count) * static_cast<double>(pixels));
}

}  // namespace imgmesh
