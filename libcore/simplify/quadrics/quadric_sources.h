// Where a collapse's quadrics come from, for either of their forms.
#pragma once

#include <vector>

#include "libcore/simplify/quadrics/matrix_quadric.h"
#include "libcore/simplify/quadrics/vertex_quadrics.h"

namespace imgmesh {

template <class Q>
inline constexpr bool kCanonical = false;
template <int C>
inline constexpr bool kCanonical<Quadric<C>> = true;

/// Those of the dense mesh; `rings` are the grid's, `gradients` those of all of it.
template <class Q>
std::vector<Q> initial_quadrics(const GridMesh& grid, const RingMesh& rings, const FeaturePatch& gradients,
                                const SimplifyParams& params) {
    if constexpr (!kCanonical<Q>)
        return matrix_quadrics<Q::kChannels>(grid, rings, gradients, params);
    else if (grid.mask.empty())
        return vertex_quadrics<Q::kChannels>(grid, gradients, params.geometry_weight);
    else
        return vertex_quadrics<Q::kChannels>(grid, rings, {}, gradients, params.geometry_weight);
}

/// Those of the mesh as it stands.
template <class Q>
std::vector<Q> rebuilt_quadrics(const RingMesh& rings, const std::vector<Q>& before,
                                const SimplifyParams& params) {
    if constexpr (kCanonical<Q>)
        return current_quadrics(rings, before, params.geometry_weight);
    else
        return matrix_quadrics<Q::kChannels>(rings, before, params);
}

}  // namespace imgmesh
