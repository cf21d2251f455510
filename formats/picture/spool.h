// Rewrites pictures that can only be read from the top, so that RegionSource reads parts of them. Target
// imgmesh::pictures.
#pragma once

#include <string>
#include <vector>

#include "formats/picture/image_io.h"

namespace imgmesh {

/// Writes a PNG, a JPEG or a TIFF in strips once more as a tiled BigTIFF without compression, and an EXR in
/// lines as one in tiles, atomically. With the same options RegionSource reads from it what read_image()
/// reads from the picture, to the bit; other programs may miss what TIFF has no words for. Holds a row of
/// tiles (32 MiB, or 16 rows if they are longer), of a TIFF in other codecs than deflate a strip as packed,
/// and of progressive JPEG all coefficients, two bytes each. Returns what read_image_file() would warn of.
/// Where a strip of a TIFF or a chunk of lines is broken, the tiles of the copy are left out.
///
/// Throws Error: kUnsupported for other formats, for interlaced PNG, and for a TIFF or EXR in tiles, in
/// groups of YCbCr or in codecs of whole strips; as read_image_file() for broken PNG and JPEG and, by
/// ImageLimits::max_memory, for the coefficients, before memory is taken; kIo if `out_path` cannot be
/// written.
std::vector<std::string> spool_picture(const std::string& path, const std::string& out_path,
                                       const ReadImageOptions& options = {});

}  // namespace imgmesh
