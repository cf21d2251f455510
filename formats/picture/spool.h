// Rewrites pictures that can only be read from the top, so that RegionSource reads parts of them. Target
// imgmesh::pictures.
#pragma once

#include <string>
#include <vector>

#include "formats/picture/image_io.h"

namespace imgmesh {

/// Writes a PNG or JPEG once more as a tiled BigTIFF without compression, atomically. With the same options
/// RegionSource reads from it what read_image() reads from the picture, to the bit; other programs may miss
/// what TIFF has no words for. Holds a row of tiles (32 MiB, or 16 rows if they are longer), and of
/// progressive JPEG all coefficients, two bytes each. Returns what read_image_file() would warn of.
///
/// Throws Error: kUnsupported for other formats and for interlaced PNG, which stay to be read as a whole; as
/// read_image_file() for broken files and, by ImageLimits::max_memory, for the coefficients, before memory is
/// taken; kIo if `out_path` cannot be written.
std::vector<std::string> spool_picture(const std::string& path, const std::string& out_path,
                                       const ReadImageOptions& options = {});

}  // namespace imgmesh
