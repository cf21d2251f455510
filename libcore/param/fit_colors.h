// Finds the vertex colours that reproduce an image best.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libcore/image/feature_space.h"
#include "libcore/image/image.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

class ColorLevels;
struct ColorSums;

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
///
/// levels  the colours that are allowed, only for Gamut::kDisplay; null for all of the gamut. The colours
///         that it starts from are rounded to them, and then each takes the level nearest to its best beside
///         its neighbours', so that some of the rounding cancels out.
/// kept    for each vertex whether its features stay as they are; empty() for none
void fit_colors(BaseMesh& mesh, const FeatureImage& feature, const std::vector<FitTerm>& terms,
                const FeatureSpace& space = {}, const ColorLevels* levels = nullptr,
                std::span<const std::uint8_t> kept = {});
/// The same from sums over the pixels, already weighted (color_sums.h). The normal equations have a mass
/// matrix: each pass over the vertices shrinks an error to a third or less.
void fit_colors(BaseMesh& mesh, const ColorSums& sums, const FeatureSpace& space, int passes,
                const ColorLevels* levels = nullptr, std::span<const std::uint8_t> kept = {});

}  // namespace imgmesh
