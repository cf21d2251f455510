// The vertex colours that reproduce a picture best.
#pragma once

#include "libcore/image/image.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/param/pixel_map.h"

namespace imgmesh {

/// One way to draw the picture from the mesh, and how much its error counts.
struct FitTerm {
    const PixelMap* map;
    double weight;
};

/// Replaces mesh.feature by the least-squares solution of sum over terms and pixels of
/// weight |w_a f_a + w_b f_b + w_c f_c - feature|^2 among the colours that a container holds (in_gamut).
/// Vertices that no pixel touches keep their value. Maps and feature have one size. Starts from what
/// mesh.feature holds. Deterministic.
void fit_colors(BaseMesh& mesh, const FeatureImage& feature, const std::vector<FitTerm>& terms);

}  // namespace imgmesh
