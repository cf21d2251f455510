// What can be wrong with a tile set beside what can be wrong with its containers (finding_codes.h).
#pragma once

#include "formats/findings/finding_codes.h"

namespace imgmesh {

/// All of them; docs/tile-sets.md explains them.
inline constexpr Finding kSetFindings[] = {
    {"set.index", "index.json is broken, or not that of a set"},
    {"set.version", "index.json has a version that this reader does not know", ErrorKind::kUnsupported},
    {"set.file", "a tile's file is not there, or has other bytes than the index tells"},
    {"set.record", "a tile's record is broken, or tells something else than the index"},
    {"set.size", "a tile's container has not the size of its place in the picture"},
    {"set.counts", "a tile's mesh has other numbers of vertices or faces than the index tells"},
    {"set.side", "neighbouring tiles have different vertices or colours on the side that they share"},
    {"set.pixels", "neighbouring tiles have the pixels of the side that they share at different places"},
    {"set.tileset", "tileset.json, or a file that it refers to, is not what the index gives"},
    warning("set.mask", "two coarser tiles of a picture with a mask differ on the side that they share"),
    warning("set.missing", "a tile could not be made"),
};

}  // namespace imgmesh
