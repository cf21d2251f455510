// WebP through libwebp itself, as it is read.
#include <webp/encode.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "formats/picture/encode/picture_encoders.h"
#include "libcore/base/error.h"

namespace imgmesh {

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
