// Validation of a whole tile set.
#pragma once

#include <string>
#include <vector>

#include "formats/findings/issue.h"
#include "formats/findings/limits.h"
#include "libcore/base/progress.h"

namespace imgmesh {

/// Returns everything that is wrong with a set: its index, the bytes of all files, every container as
/// validate_container() does, the sides that tiles share, which must agree to the bit, and the files of 3D
/// Tiles. Kinds are members of kSetFindings and kFindings; texts begin with the file's path below the folder.
///
/// In levels above 0 the picture's right and bottom side may lie between two pixels, so mesh.outside and
/// mesh.area of tiles there are no findings.
///
/// limits  of each container
///
/// Safe for any bytes. Holds one tile, and the sides of a row of tiles. Takes the time of reading all
/// containers twice.
std::vector<Issue> validate_tile_set(const std::string& folder, const ContainerLimits& limits = {},
                                     const Progress& progress = {});

}  // namespace imgmesh
