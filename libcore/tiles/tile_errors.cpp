#include "libcore/tiles/tile_errors.h"

#include "libcore/base/index.h"

namespace imgmesh {
namespace {

double squared_error(const BaseMesh& mesh, const PixelCoord& coord, const float* feature) {
    const Face& face = mesh.faces[coord.face];
    const double weights[] = {1.0 - coord.u - coord.v, coord.u, coord.v};
    double sum = 0;
    for (int c = 0; c < mesh.channels; ++c) {
        double drawn = 0;
        for (std::size_t k = 0; k < 3; ++k) drawn += weights[k] * double{mesh.feature_of(face[k])[c]};
        sum += (drawn - feature[c]) * (drawn - feature[c]);
    }
    return sum;
}

}  // namespace

TileErrors tile_errors(const Level& level, const FeatureImage& feature, const Mask& own,
                       const TileSeams& seams) {
    TileErrors errors;
    const int right = feature.width - 1, bottom = feature.height - 1;
    for (int y = 0; y <= bottom; ++y)
        for (int x = 0; x <= right; ++x) {
            const PixelCoord& coord = level.map.at(x, y);
            if (coord.face == kNone || !own.at(x, y)) continue;
            const double square = squared_error(level.mesh, coord, feature.pixel(x, y));
            ++errors.pixels;
            errors.squares += square;
            if ((seams.left && x <= kSeamReach) || (seams.top && y <= kSeamReach) ||
                (seams.right && right - x <= kSeamReach) || (seams.bottom && bottom - y <= kSeamReach)) {
                ++errors.seam_pixels;
                errors.seam_squares += square;
            }
        }
    return errors;
}

}  // namespace imgmesh
