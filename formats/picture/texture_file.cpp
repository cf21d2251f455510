#include "formats/picture/texture_file.h"

#include "formats/picture/image_io.h"
#include "libcore/base/error.h"

namespace imgmesh {

std::vector<std::uint8_t> encode_texture(const Image& image, const Mask& mask, TextureType type,
                                         TextureAlpha alpha) {
    const Image texture = texture_image(image, mask, alpha);
    if (type == TextureType::kJpeg && texture.channels == 4)
        throw Error(ErrorKind::kUnsupported, "a JPEG texture cannot hold a mask or an alpha, a PNG can");
    return encode_image(type == TextureType::kPng ? "texture.png" : "texture.jpg", texture,
                        SampleType::kUint8);
}

}  // namespace imgmesh
