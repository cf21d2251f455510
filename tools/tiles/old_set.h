// What a folder has of another tile set when a new one is to be made there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/tileset/tile_set.h"

namespace imgmesh {

/// Makes way for a set with that plan. If the folder has a set of another plan, its index goes, so that
/// nobody takes it for complete any more, and so do the files of tiles that the new set does not have. Its
/// other tiles stay until new ones replace them. Only files with the names of a set's are removed.
/// `warnings` gets a line about it.
///
/// Returns how many files of tiles were removed. Throws Error: kBadArgument if the folder has a file with the
/// name of one of a set's that is none; kIo if a file cannot be removed, and without `overwrite` if there is
/// a set of another plan.
std::int64_t make_way(const std::string& folder, const TileSetPlan& plan, bool overwrite,
                      std::vector<std::string>& warnings);

}  // namespace imgmesh
