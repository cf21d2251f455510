// Good BMP, TGA and Netpbm files to start from.
#pragma once

#include <vector>

#include "tests/fuzz/mutate.h"

namespace imgmesh::fuzz {

/// One file for each header, coding and depth that the readers know.
std::vector<Bytes> small_seeds();

}  // namespace imgmesh::fuzz
