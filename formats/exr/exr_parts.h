// Writes several images as the parts of one EXR file. Target imgmesh::pictures.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "libcore/base/types.h"
#include "libcore/image/image.h"

namespace imgmesh {

/// An image and the name of its part.
struct NamedImage {
    std::string name;
    Image image;
};

/// Writes the images, at least one, as parts in this order: scanlines, ZIP, FLOAT channels of the images'
/// names. Values are written as they are, without a colour space and without alpha multiplied in. No two
/// names may be equal. An image is the data window of its part; the display window of all parts is the first
/// image, as OpenEXR demands.
///
/// The file appears whole or not at all. Throws Error(kIo) if it cannot be written, or exists and
/// `overwrite` is false.
void write_exr_parts(const std::string& path, const std::vector<NamedImage>& parts, bool overwrite);

/// Writes one channel, UINT or FLOAT, of width * height values as an EXR of one part. Otherwise as above.
void write_exr_channel(const std::string& path, const std::string& channel, int width, int height,
                       std::span<const Id> values, bool overwrite);
void write_exr_channel(const std::string& path, const std::string& channel, int width, int height,
                       std::span<const float> values, bool overwrite);

}  // namespace imgmesh
