// EXR images through OpenEXR itself: OpenImageIO's reader can abort on a corrupt file.
#include "formats/exr/exr_opaque.h"
#include "formats/exr/memory_input.h"
#include "formats/picture/decode/exr_picture.h"
#include "formats/picture/decode/picture_decoders.h"

namespace imgmesh {

DecodedPicture decode_exr(const PictureFile& picture) {
    make_attributes_opaque(picture.path, picture.bytes);
    MemoryInput stream(picture.path.c_str(), picture.bytes);
    return ExrPicture(picture.path, stream, picture.options, picture.options.limits).read_all();
}

}  // namespace imgmesh
