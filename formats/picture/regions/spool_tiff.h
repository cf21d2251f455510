// TIFF in few large strips, which is read from the top. Internal to this room.
#pragma once

#include <string>
#include <vector>

#include "formats/picture/decode/tiff_layout.h"
#include "formats/picture/image_io.h"

namespace imgmesh {

/// Whether strips are so large that undoing one for each region is a waste, and can be undone row by row.
bool is_spooled(const TiffFile& file, const TiffLayout& layout);

/// Writes the rows into tiles, with all tags that a reader of the pixels looks at. Where a strip is
/// broken, tiles are left out; Error(kBadFile) if all are. Returns warnings. Throws as spool_picture() does,
/// also Error(kUnsupported) for a TIFF that is not spooled.
std::vector<std::string> spool_tiff(const std::string& path, const std::string& out_path,
                                    const ReadImageOptions& options);

}  // namespace imgmesh
