// EXR in packed lines of wide pictures, which is rewritten in tiles. Internal to this room.
#pragma once

#include <string>
#include <vector>

#include "formats/picture/decode/exr_picture.h"

namespace imgmesh {

/// Whether its lines can be rewritten: not tiles, and no subsampled channels, which tiles cannot have.
bool has_lines(const ExrPicture& picture);
/// Whether undoing chunks of lines for each tile beside each other is a waste.
bool is_spooled(const ExrPicture& picture);

/// Writes an EXR whose part has tiles, with the same headers, and of the other parts only these; channels
/// that the options do not choose are 0. Lines that are broken are left out. Holds a row of tiles: 32 MiB, or
/// 16 lines if they are longer. Returns warnings. Throws as spool_picture() does, also Error(kUnsupported)
/// without has_lines().
std::vector<std::string> spool_exr(const std::string& path, const std::string& out_path,
                                   const ReadImageOptions& options);

}  // namespace imgmesh
