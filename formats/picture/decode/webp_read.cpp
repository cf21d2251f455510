// WebP through libwebp itself. OpenImageIO's reader rounds colours under alpha to 8 bits in another space,
// ignores the orientation, and reads each frame of an animation into memory.
#include <webp/decode.h>
#include <webp/demux.h>

#include <memory>

#include "formats/files/byte_reader.h"
#include "formats/picture/decode/exif.h"
#include "formats/picture/decode/picture_decoders.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;

Bytes chunk(const WebPDemuxer* demuxer, const char* name) {
    WebPChunkIterator iterator;
    Bytes bytes;
    if (WebPDemuxGetChunk(demuxer, name, 1, &iterator))
        bytes = {iterator.chunk.bytes, iterator.chunk.size};  // points into the file's bytes
    WebPDemuxReleaseChunkIterator(&iterator);
    return bytes;
}

}  // namespace

DecodedPicture decode_webp(const PictureFile& file) {
    const std::string& path = file.path;
    const auto broken = [&](const char* what) {
        return Error(ErrorKind::kBadFile, cat(path, ": cannot read the WebP: ", what));
    };
    const WebPData data{file.bytes.data(), file.bytes.size()};
    const std::unique_ptr<WebPDemuxer, decltype(&WebPDemuxDelete)> demuxer(WebPDemux(&data), WebPDemuxDelete);
    if (!demuxer) throw broken("it is truncated or broken");
    const auto width = static_cast<int>(WebPDemuxGetI(demuxer.get(), WEBP_FF_CANVAS_WIDTH));
    const auto height = static_cast<int>(WebPDemuxGetI(demuxer.get(), WEBP_FF_CANVAS_HEIGHT));
    const bool alpha = WebPDemuxGetI(demuxer.get(), WEBP_FF_FORMAT_FLAGS) & ALPHA_FLAG;
    check_size(path, width, height, alpha ? 4 : 3, file.options.limits);

    WebPIterator frame;
    const bool found = WebPDemuxGetFrame(demuxer.get(), 1, &frame);
    const std::unique_ptr<WebPIterator, decltype(&WebPDemuxReleaseIterator)> release(
        &frame, WebPDemuxReleaseIterator);
    if (!found || !frame.complete) throw broken("its first image is missing");
    const std::size_t size =
        std::size_t{4} * static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
    std::vector<std::uint8_t> pixels(size);
    if (!WebPDecodeRGBAInto(frame.fragment.bytes, frame.fragment.size, pixels.data(), size, 4 * frame.width))
        throw broken("its first image is truncated or broken");

    // An animation's first frame may cover only part of the canvas; the rest is transparent.
    DecodedPicture out;
    out.image = make_image(width, height, alpha || frame.width < width || frame.height < height ? 4 : 3);
    for (int y = 0; y < frame.height && y + frame.y_offset < height; ++y)
        for (int x = 0; x < frame.width && x + frame.x_offset < width; ++x)
            for (int c = 0; c < out.image.channels; ++c)
                out.image.pixel(x + frame.x_offset, y + frame.y_offset)[c] =
                    static_cast<float>(
                        pixels[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) +
                                    static_cast<std::size_t>(x)) +
                               static_cast<std::size_t>(c)]) /
                    255.0f;
    out.orientation = exif_facts(chunk(demuxer.get(), "EXIF")).orientation;
    if (out.orientation == 0) out.orientation = xmp_orientation(text_of(chunk(demuxer.get(), "XMP ")));
    const Bytes profile = chunk(demuxer.get(), "ICCP");
    out.color.icc.assign(profile.begin(), profile.end());
    return out;
}

}  // namespace imgmesh
