// Which holes lie in which outline.
#pragma once

#include <cstddef>
#include <vector>

#include "libcore/mesh/loop.h"

namespace imgmesh {

/// Returns for each outer loop, in their order, its index and then those of its holes. A hole belongs to the
/// smallest outer loop around it. Takes O(loops * corners) time.
///
/// loops  as mask_contours() in outline.h gives them: without crossings, though points may be shared
/// Throws Error(kInternal) for a hole in no outer loop.
std::vector<std::vector<std::size_t>> loop_parts(const std::vector<Loop>& loops);

}  // namespace imgmesh
