// WebP through libwebp itself. OpenImageIO's reader rounds colours under alpha to 8 bits in another space,
// ignores the orientation, and reads each frame of an animation into memory.
#include <webp/decode.h>
#include <webp/demux.h>
#include <webp/encode.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "formats/picture/exif.h"
#include "formats/picture/icc_profile.h"
#include "formats/picture/picture_decoders.h"
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

DecodedPicture decode_webp(const std::string& path, Bytes bytes, const ImageLimits& limits) {
    const auto broken = [&](const char* what) {
        return Error(ErrorKind::kBadFile, cat(path, ": cannot read the WebP: ", what));
    };
    const WebPData data{bytes.data(), bytes.size()};
    const std::unique_ptr<WebPDemuxer, decltype(&WebPDemuxDelete)> demuxer(WebPDemux(&data), WebPDemuxDelete);
    if (!demuxer) throw broken("it is truncated or broken");
    const auto width = static_cast<int>(WebPDemuxGetI(demuxer.get(), WEBP_FF_CANVAS_WIDTH));
    const auto height = static_cast<int>(WebPDemuxGetI(demuxer.get(), WEBP_FF_CANVAS_HEIGHT));
    const bool alpha = WebPDemuxGetI(demuxer.get(), WEBP_FF_FORMAT_FLAGS) & ALPHA_FLAG;
    check_size(path, width, height, alpha ? 4 : 3, limits);

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
    out.orientation = exif_orientation(chunk(demuxer.get(), "EXIF"));
    out.color_space = color_space_from_icc(chunk(demuxer.get(), "ICCP"));
    return out;
}

std::vector<std::uint8_t> encode_webp(const Image& image) {
    const int red = std::max(image.channel("R"), 0), green = std::max(image.channel("G"), 0),
              blue = std::max(image.channel("B"), 0), alpha = image.channel("A");
    std::vector<std::uint8_t> pixels;
    pixels.reserve(4 * image.pixel_count());
    const auto code = [](float value) {
        return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
    };
    for (std::size_t i = 0; i < image.data.size(); i += static_cast<std::size_t>(image.channels)) {
        const float* in = image.data.data() + i;
        for (const int c : {red, green, blue}) pixels.push_back(code(in[c]));
        pixels.push_back(alpha >= 0 ? code(in[alpha]) : 255);
    }

    // "exact" keeps the colour under transparent pixels.
    WebPConfig config;
    WebPPicture picture;
    WebPMemoryWriter writer;
    if (!WebPConfigInit(&config) || !WebPConfigLosslessPreset(&config, 6) || !WebPPictureInit(&picture))
        throw Error(ErrorKind::kInternal, "libwebp is of another version than its headers");
    config.exact = 1;
    WebPMemoryWriterInit(&writer);
    const std::unique_ptr<WebPMemoryWriter, decltype(&WebPMemoryWriterClear)> clear(&writer,
                                                                                    WebPMemoryWriterClear);
    picture.use_argb = 1;
    picture.width = image.width;
    picture.height = image.height;
    picture.writer = WebPMemoryWrite;
    picture.custom_ptr = &writer;
    const bool done =
        WebPPictureImportRGBA(&picture, pixels.data(), 4 * image.width) && WebPEncode(&config, &picture);
    WebPPictureFree(&picture);
    if (!done) throw std::bad_alloc();  // sizes and options are checked, so memory is the only cause left
    return {writer.mem, writer.mem + writer.size};
}

}  // namespace imgmesh
