// Good BMP, TGA and Netpbm files and compact streams to start from.
#pragma once

#include <vector>

#include "tests/fuzz/mutate.h"

namespace imgmesh::fuzz {

/// Each returns one file for each header, coding and depth that the reader knows.
std::vector<Bytes> bmp_seeds();
std::vector<Bytes> tga_seeds();
std::vector<Bytes> netpbm_seeds();
std::vector<Bytes> compact_seeds();

}  // namespace imgmesh::fuzz
