#include "formats/image_text.h"

#include <OpenImageIO/imagebufalgo.h>

#include "formats/picture_decoders.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

OIIO::ImageBufAlgo::TextAlignX oiio_align(TextAlign align) {
    switch (align) {
        case TextAlign::kLeft:
            return OIIO::ImageBufAlgo::TextAlignX::Left;
        case TextAlign::kCenter:
            return OIIO::ImageBufAlgo::TextAlignX::Center;
        case TextAlign::kRight:
            break;
    }
    return OIIO::ImageBufAlgo::TextAlignX::Right;
}

}  // namespace

void draw_text(Image& image, const TextLabel& label) {
    const OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeFloat);
    OIIO::ImageBuf buffer(spec, image.data.data());  // draws into the picture itself
    if (!OIIO::ImageBufAlgo::render_text(buffer, label.x, label.y, label.text, label.size, "DejaVuSans",
                                         {label.color.data(), 3}, oiio_align(label.align),
                                         OIIO::ImageBufAlgo::TextAlignY::Baseline))
        throw Error(ErrorCode::kUnsupported, cat("cannot draw text: ", one_line(buffer.geterror())));
}

}  // namespace imgmesh
