// The mask of --mask.
#pragma once

#include <string>
#include <vector>

#include "formats/picture/image_io.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// Reads the mask of an image and checks it against that image, which `name` names. Throws Error that names
/// the mask's file: kBadFile for another size, kUnsupported if it leaves no pixel inside. Adds to
/// `warnings`.
Mask read_mask(const std::string& path, double threshold, const ImageLimits& limits, const Image& image,
               const std::string& name, std::vector<std::string>& warnings);

}  // namespace imgmesh
