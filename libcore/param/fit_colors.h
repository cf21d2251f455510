// Finds the vertex colours that reproduce an image best.
#pragma once

#include "libcore/image/feature_space.h"
#include "libcore/image/image.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// One way to draw the image from the mesh, and the weight of its error.
struct FitTerm {
    const PixelMap* map;
    double weight;
};

/// Replaces mesh.feature by the least-squares solution of the sum over terms and pixels of
/// weight |w_a f_a + w_b f_b + w_c f_c - feature|^2, with colours in space.gamut
/// (in_gamut). It starts from mesh.feature. Vertices that no pixel touches keep their
/// value. Maps and feature have one size, mesh and feature have the features of `space`.
/// Deterministic.
void fit_colors(BaseMesh& mesh, const FeatureImage& feature, const std::vector<FitTerm>& terms,
                const FeatureSpace& space = {});

}  // namespace imgmesh
