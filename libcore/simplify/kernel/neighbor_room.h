#pragma once

#include "libcore/mesh/ring_mesh.h"

namespace imgmesh {

/// Room for as many numbers as a vertex may have neighbours, in whole vectors of eight.
inline constexpr int kNeighborRoom = 16;
static_assert(kNeighborRoom >= kMaxValence && kNeighborRoom % 8 == 0);

}  // namespace imgmesh
