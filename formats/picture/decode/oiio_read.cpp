// Formats that OpenImageIO reads and writes for imgmesh.
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/oiio_module.h"

namespace imgmesh {

DecodedPicture decode_with_oiio(const PictureFile& file) {
    OiioPicture picture =
        oiio_module().decode(file.path, file.bytes, file.claim, file.options.limits, &check_size);
    DecodedPicture out;
    out.image.width = picture.width;
    out.image.height = picture.height;
    out.image.channels = picture.channels;
    out.image.channel_names = std::move(picture.channel_names);
    out.image.sample_type = picture.sample_type;
    out.image.data = std::move(picture.data);
    out.orientation = picture.orientation;
    out.color.icc = std::move(picture.icc);
    out.color.gamma = picture.gamma;
    out.color.name = std::move(picture.color_name);
    return out;
}

}  // namespace imgmesh
