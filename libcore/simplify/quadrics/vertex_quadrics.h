// The quadrics that the dense mesh's vertices start with (paper sec. 3.2).
#pragma once

#include <vector>

#include "libcore/mesh/grid_mesh.h"
#include "libcore/mesh/ring_mesh.h"
#include "libcore/simplify/quadrics/quadric.h"

namespace imgmesh {

/// Sum over the faces around each vertex of area times the face's *flattened* quadric: lambda times the
/// squared distance to the face's centroid, plus the squared distance to the face's linear colour function
/// (Hoppe 1999). A face's colours are those of its corners at this vertex, its gradient is taken from
/// `gradients`, usually from smoothed_patch(); they must reach to the neighbours of the vertices asked for.
///
/// grid, gradients   C channels; C is 3, 8 or 16 (padded_features); no mask
/// lambda            geometry against colour [feature^2 / px^2], > 0
/// return            one quadric a vertex, in the grid's order
template <int C>
std::vector<Quadric<C>> vertex_quadrics(const GridMesh& grid, const FeaturePatch& gradients, float lambda);

/// Of the pixels of a rectangle alone, row by row into `out`.
template <int C>
void vertex_quadrics(const GridMesh& grid, const FeaturePatch& gradients, float lambda, const PixelRect& rect,
                     Quadric<C>* out);

/// The same for any grid mesh, with or without a mask, or for part of it.
///
/// rings      of vertices of the dense mesh; of one without a ring only the place counts
/// number     of each of them in the grid mesh; empty where it is the same
template <int C>
std::vector<Quadric<C>> vertex_quadrics(const GridMesh& grid, const RingMesh& rings,
                                        const std::vector<Id>& number, const FeaturePatch& gradients,
                                        float lambda);

/// The same over the faces of the mesh as it stands, positions from `rings`, colours from the quadrics
/// `before`.
template <int C>
std::vector<Quadric<C>> current_quadrics(const RingMesh& rings, const std::vector<Quadric<C>>& before,
                                         float lambda);

}  // namespace imgmesh
