// Good BMP, TGA and Netpbm files, compact streams and coded pictures to start from.
#pragma once

#include <vector>

#include "tests/fuzz/mutate.h"

namespace imgmesh::fuzz {

/// Each returns one file for each header, coding and depth that the reader knows.
std::vector<Bytes> bmp_seeds();
std::vector<Bytes> tga_seeds();
std::vector<Bytes> netpbm_seeds();
std::vector<Bytes> compact_seeds();
std::vector<Bytes> coded_seeds();

}  // namespace imgmesh::fuzz
