// EXR images through OpenEXR itself, as they are read.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include <algorithm>

#include "formats/exr/memory_output.h"
#include "formats/picture/encode/picture_encoders.h"

namespace imgmesh {
std::vector<std::uint8_t> encode_exr(const Image& image, SampleType type) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<Imath::half> halves;
    if (type == SampleType::kHalf) {
        halves.reserve(image.data.size());
        // A half holds no number above 65504 except infinity, which nothing reads.
        for (const float value : image.data) halves.emplace_back(std::clamp(value, -65504.0f, 65504.0f));
    }

    Imf::Header header(image.width, image.height, 1, {0, 0}, 1, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    Imf::FrameBuffer buffer;
    const auto insert = [&](std::size_t c, Imf::PixelType pixel_type, const auto* data) {
        const std::size_t stride = channels * sizeof(*data);
        header.channels().insert(image.channel_names[c], Imf::Channel(pixel_type));
        buffer.insert(image.channel_names[c], Imf::Slice::Make(pixel_type, data + c, {0, 0}, image.width,
                                                               image.height, stride, stride * width));
    };
    for (std::size_t c = 0; c < channels; ++c) {
        if (halves.empty())
            insert(c, Imf::FLOAT, image.data.data());
        else
            insert(c, Imf::HALF, halves.data());
    }

    MemoryOutput stream;
    {
        Imf::OutputFile file(stream, header, /*numThreads=*/0);
        file.setFrameBuffer(buffer);
        file.writePixels(image.height);
    }  // writes the table of offsets
    return std::move(stream.bytes);
}

}  // namespace imgmesh
