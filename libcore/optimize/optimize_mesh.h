// Optimisation of a base mesh: its vertices, edges and colours for the least error of its drawing.
#pragma once

#include "libcore/base/progress.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/refine/refine_params.h"

namespace imgmesh {

/// Squared error summed over pixels and channels.
struct OptimizeReport {
    double before = 0;  ///< with fitted colours
    double after = 0;
};

/// Lowers the squared error of the mesh drawn with colours interpolated linearly over its faces, plus
/// weighted shape. Each of `params.rounds` adds the share `params.exchange` of the vertices where they gain
/// most, lets the mesh settle, and removes as many where they cost least; the best mesh is kept. Sweeps of
/// annealing and twice as many rounds of fewer vertices follow if `params.anneal` is above 0. The number of
/// vertices stays, and with `params.keep_faces` that of faces. Lower errors than refine()
/// (libcore/refine/refine.h), and thinner triangles: a hundredth of the longest edge is the least height.
///
/// mesh   any boundary, three channels, positions on kPositionStep; corners and boundaries stay, except that
///        vertices on straight sides of the bounding box slide
/// image  what to draw, in the space of mesh.feature, at least 2 x 2 pixels; pixels outside the mesh do not
///        count, nor do those outside `mask`, which is empty() or of the image's size
///
/// The bits are the same on every machine. Takes 64 bytes a pixel, 96 with a mask. Source:
/// docs/decisions/0048-optimised-meshes.md.
OptimizeReport optimize_mesh(BaseMesh& mesh, const FeatureImage& image, const RefineParams& params,
                             const Progress& progress = {}, const Mask& mask = {});

}  // namespace imgmesh
