// Several float images as the parts of one EXR file. Target imgmesh_pictures.
#pragma once

#include <string>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

struct NamedImage {
    std::string name;
    Image image;
};

/// Writes the images as parts with these names, in this order, atomically: scanlines, ZIP, FLOAT channels
/// under their names, unchanged numbers (no colour space, no premultiplied alpha). Each image is its part's
/// data window. The display window of all parts is the first image, as OpenEXR requires. There is at least
/// one image; names differ. Throws Error(kIo) if the file cannot be written.
void write_exr_parts(const std::string& path, const std::vector<NamedImage>& parts, bool overwrite);

}  // namespace imgmesh
