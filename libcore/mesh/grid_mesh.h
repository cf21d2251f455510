// The dense mesh that the collapse starts from: one vertex a pixel (paper sec. 3.1).
#pragma once

#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

/// A W x H grid of pixels as a triangle mesh. Connectivity is implicit: cell (x, y) is the quad of pixels (x,
/// y) to (x+1, y+1), split by one diagonal; vertex (x, y) has the number y * W + x.
struct GridMesh {
    FeatureImage feature;  ///< at the vertices; width, height >= 2
    float origin_x = 0;    ///< position of vertex (0, 0) [pixels]: 0, or -0.5 where the picture's
    float origin_y = 0;    ///< side is one pixel, which then counts as a strip one pixel wide
    std::vector<std::uint8_t> diagonal;  ///< (W-1) x (H-1): 1 joins top left to bottom right, 0 the other two

    bool falling_diagonal(int x, int y) const {
        return diagonal[static_cast<std::size_t>(y) * static_cast<std::size_t>(feature.width - 1) +
                        static_cast<std::size_t>(x)] != 0;
    }
};

/// Splits each cell along the diagonal whose ends differ less in feature space (paper sec. 3.1); ties fall
/// from top left to bottom right. A side of one pixel is doubled at -0.5 and +0.5. Takes any size from 1 x 1.
GridMesh grid_mesh(FeatureImage feature);

/// A copy smoothed by `passes` of the separable [1 2 1] / 4 filter, borders repeated. Gradients are taken
/// from such a copy: most of the error of gradient-based quadrics is noise in per-pixel gradients
/// (docs/paper-map.md).
FeatureImage smoothed(const FeatureImage& feature, int passes);

}  // namespace imgmesh
