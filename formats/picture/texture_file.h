// Textures: images as engines put them on meshes. Target imgmesh::pictures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/image/texture_image.h"

namespace imgmesh {

/// The two kinds of image that glTF has.
enum class TextureType {
    kPng,  ///< lossless
    kJpeg  ///< quality 95, without transparency
};

/// The image as the bytes of a PNG or JPEG file, for Texture::picture: 8-bit sRGB, clipped to what a display
/// shows. Pixels near the mask get the colours of their neighbours inside, as engines mix neighbouring
/// pixels.
///
/// mask   empty() for none, else of the image's size
/// alpha  what is transparent
///
/// Same bytes for the same image. Takes O(pixels) time. Throws Error(kUnsupported) for an image without
/// colour, and for a masked or transparent one as JPEG; Error(kBadArgument) for an image too large for the
/// format.
std::vector<std::uint8_t> encode_texture(const Image& image, const Mask& mask, TextureType type,
                                         TextureAlpha alpha = TextureAlpha::kMask);

}  // namespace imgmesh
