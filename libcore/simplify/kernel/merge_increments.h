// By how much merging a vertex with each of its neighbours would raise the error, with SIMD where the
// processor has it.
#pragma once

#include "libcore/simplify/kernel/neighbor_room.h"
#include "libcore/simplify/quadrics/quadric.h"

namespace imgmesh {

/// out[k] = merged_minimum(quadrics[i], quadrics[others[k]]).increment for 0 <= k < count. Both arrays have
/// kNeighborRoom places; those behind `count` are overwritten.
template <int C, class Number>
inline void merge_increments(const Quadric<C>* quadrics, Number i, Number* others, int count, float* out) {
    for (int k = 0; k < count; ++k) out[k] = merged_minimum(quadrics[i], quadrics[others[k]]).increment;
}
/// The same bits on any processor.
void merge_increments(const Quadric<3>* quadrics, Id i, Id* others, int count, float* out);

}  // namespace imgmesh
