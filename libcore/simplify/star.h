// What a collapse computes for all neighbours of a vertex at once, with SIMD where the processor has it.
#pragma once

#include "libcore/mesh/ring_mesh.h"
#include "libcore/simplify/quadric.h"
#include "libcore/simplify/star_limits.h"

namespace imgmesh {

/// Room for as many numbers as a vertex may have neighbours, in whole vectors.
inline constexpr int kStarRoom = 16;
static_assert(kStarRoom >= kMaxValence);

/// out[k] = merged_minimum(quadrics[i], quadrics[others[k]]).increment for 0 <= k < count; both arrays have
/// kStarRoom places, of which those behind `count` are written over.
template <int C>
inline void star_increments(const Quadric<C>* quadrics, Id i, Id* others, int count, float* out) {
    for (int k = 0; k < count; ++k) out[k] = merged_minimum(quadrics[i], quadrics[others[k]]).increment;
}
/// Bit for bit the same, on any processor.
void star_increments(const Quadric<3>* quadrics, Id i, Id* others, int count, float* out);

}  // namespace imgmesh
