// Refinement: adjusts the base mesh's vertices, edges and colours to the image's own pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/base/progress.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/refine/refine_params.h"

namespace imgmesh {

struct RefineReport {
    /// Squared error summed over pixels and channels: first with fitted colours, then after each round.
    std::vector<double> error;
    std::int64_t moves = 0, flips = 0, relocations = 0;
};

/// Lowers the squared error of the mesh drawn with colours interpolated linearly over its faces. Each round
/// flips edges, relocates vertices from where their loss costs least to where they gain most, moves vertices
/// by Gauss-Newton steps, and fits all colours by least squares. Every step lowers the sum of error and
/// weighted shape. A round that does not lower the error itself is dropped, and so are all after it, so the
/// error never rises. The numbers of vertices and of faces stay.
///
/// mesh   any boundary, three channels, positions on kPositionStep; corners and boundaries stay, except that
///        vertices on straight sides of the bounding box slide
/// image  what to draw, in the space of mesh.feature; pixels outside the mesh do not count, nor do those
///        outside `mask`, which is empty() or of the image's size
///
/// Source: docs/decisions/0012-refinement.md. The result is the same for any number of threads.
RefineReport refine(BaseMesh& mesh, const FeatureImage& image, const RefineParams& params,
                    const Progress& progress = {}, const Mask& mask = {});

}  // namespace imgmesh
