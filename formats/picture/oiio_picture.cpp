// Formats that OpenImageIO reads and writes for imgmesh.
#include "formats/picture/oiio_module.h"
#include "formats/picture/picture_decoders.h"
#include "formats/picture/stated_color.h"

namespace imgmesh {

DecodedPicture decode_with_oiio(const std::string& path, std::span<const std::uint8_t> bytes,
                                const PictureClaim& claim, const ImageLimits& limits) {
    OiioPicture picture = oiio_module().decode(path, bytes, claim, limits, &check_size);
    DecodedPicture out;
    out.image.width = picture.width;
    out.image.height = picture.height;
    out.image.channels = picture.channels;
    out.image.channel_names = std::move(picture.channel_names);
    out.image.sample_type = picture.sample_type;
    out.image.data = std::move(picture.data);
    out.associated_alpha = picture.associated_alpha;
    out.orientation = picture.orientation;
    out.color_space = stated_color_space({picture.icc, picture.gamma, picture.color_name}, out.image);
    return out;
}

}  // namespace imgmesh
