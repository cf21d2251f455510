// The file that Texture::image is. Target imgmesh_pictures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// The formats that glTF knows: lossless, or of quality 95 and without transparency.
enum class TextureType { kPng, kJpeg };

/// Returns texture_image(image, mask) as a file of 8-bit sRGB. The same image gives the same bytes. Throws
/// Error(kUnsupported) for an image without colour, and for a masked image as JPEG; Error(kBadArgument) if it
/// is too large for the format.
std::vector<std::uint8_t> encode_texture(const Image& image, const Mask& mask, TextureType type);

}  // namespace imgmesh
