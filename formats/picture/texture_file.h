// Textures: images as engines put them on meshes. Target imgmesh::pictures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// The two kinds of image that glTF has.
enum class TextureType {
    kPng,  ///< lossless
    kJpeg  ///< quality 95, without transparency
};

/// The image as the bytes of a PNG or JPEG file, for Texture::picture: 8-bit sRGB, clipped to what a display
/// shows, with an alpha of 1 inside the mask and 0 outside, whatever alpha the image has. Pixels near the
/// mask get the colours of their neighbours inside, as engines mix neighbouring pixels.
///
/// mask  empty() for none, else of the image's size
///
/// Same bytes for the same image. Takes O(pixels) time. Throws Error(kUnsupported) for an image without
/// colour, and for a masked one as JPEG; Error(kBadArgument) for an image too large for the format.
std::vector<std::uint8_t> encode_texture(const Image& image, const Mask& mask, TextureType type);

}  // namespace imgmesh
