#include "formats/picture/texture_file.h"

#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "libcore/image/texture_image.h"

namespace imgmesh {

std::vector<std::uint8_t> encode_texture(const Image& image, const Mask& mask, TextureType type) {
    if (type == TextureType::kJpeg && !mask.empty())
        throw Error(ErrorKind::kUnsupported, "a JPEG texture cannot hold a mask, a PNG can");
    return encode_image(type == TextureType::kPng ? "texture.png" : "texture.jpg", texture_image(image, mask),
                        SampleType::kUint8);
}

}  // namespace imgmesh
