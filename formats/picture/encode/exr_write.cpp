// EXR images through OpenEXR itself, as they are read.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include <algorithm>

#include "formats/exr/memory_output.h"
#include "formats/picture/color/primaries.h"
#include "formats/picture/encode/picture_encoders.h"
#include "formats/picture/exr_facts.h"

namespace imgmesh {
namespace {

Primaries primaries_of(const ExrAttribute& a) {
    const auto point = [&](std::size_t i) { return Chromaticity{a.numbers[i], a.numbers[i + 1]}; };
    return {point(0), point(2), point(4), point(6)};
}

struct Windows {
    Imath::Box2i shown, stored;
};

// The windows of the metadata if they are this image's. What was stored beyond the shown window is lost.
Windows windows_of(const Image& image, const ExrMetadata& metadata) {
    const Imath::Box2i whole({0, 0}, {image.width - 1, image.height - 1});
    const ExrAttribute* const shown = find_attribute(metadata, "displayWindow");
    const ExrAttribute* const stored = find_attribute(metadata, "dataWindow");
    if (!shown || window_of(*shown).size() != whole.size()) return {whole, whole};
    Windows out{window_of(*shown), window_of(*shown)};
    if (!stored) return out;
    const Imath::Box2i was = window_of(*stored);
    const Imath::Box2i both({std::max(was.min.x, out.shown.min.x), std::max(was.min.y, out.shown.min.y)},
                            {std::min(was.max.x, out.shown.max.x), std::min(was.max.y, out.shown.max.y)});
    if (!both.isEmpty()) out.stored = both;
    return out;
}

}  // namespace

std::vector<std::uint8_t> encode_exr(Image image, SampleType type, const ExrMetadata& metadata) {
    if (const ExrAttribute* const stated = find_attribute(metadata, "chromaticities"))
        convert_primaries("EXR", kRec709Primaries, primaries_of(*stated), image);
    const auto channels = static_cast<std::size_t>(image.channels);
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<Imath::half> halves;
    if (type == SampleType::kHalf) {
        halves.reserve(image.data.size());
        // A half holds no number above 65504 except infinity, which nothing reads.
        for (const float value : image.data) halves.emplace_back(std::clamp(value, -65504.0f, 65504.0f));
    }

    const Windows windows = windows_of(image, metadata);
    Imf::Header header(windows.shown, windows.stored, 1, {0, 0}, 1, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    add_metadata(metadata, header);
    Imf::FrameBuffer buffer;
    const auto insert = [&](std::size_t c, Imf::PixelType pixel_type, const auto* data) {
        const std::size_t stride = channels * sizeof(*data);
        header.channels().insert(image.channel_names[c], Imf::Channel(pixel_type));
        buffer.insert(image.channel_names[c],
                      Imf::Slice::Make(pixel_type, data + c, windows.shown.min, image.width, image.height,
                                       stride, stride * width));
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
        file.writePixels(windows.stored.max.y - windows.stored.min.y + 1);
    }  // writes the table of offsets
    return std::move(stream.bytes);
}

}  // namespace imgmesh
