// Several images of floats as the parts of one EXR file. Target imgmesh_pictures.
#pragma once

#include <string>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

struct NamedImage {
    std::string name;
    Image image;
};

/// Writes the images as parts of these names, in this order, atomically: scanlines, ZIP, FLOAT channels as
/// named, numbers as they are (no colour space, no alpha multiplied in). An image is its part's data window;
/// the display window of all is the first image, as OpenEXR wants it. At least one; names differ. Throws
/// Error(kIo) where the file cannot be written.
void write_exr_parts(const std::string& path, const std::vector<NamedImage>& parts, bool overwrite);

}  // namespace imgmesh
