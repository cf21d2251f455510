// EXR images through OpenEXR itself: OpenImageIO's reader can abort on a corrupt file.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "formats/exr/exr_opaque.h"
#include "formats/exr/memory_input.h"
#include "formats/files/library_error.h"
#include "formats/picture/decode/picture_decoders.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

std::int64_t length(int first, int last) {
    return std::int64_t{last} - first + 1;
}

// Colour comes first, in our order, then the file's other channels by name.
std::vector<std::string> channel_order(const Imf::ChannelList& channels) {
    constexpr std::string_view kColor[] = {"R", "G", "B", "Y", "A"};
    std::vector<std::string> names;
    for (const std::string_view name : kColor)
        if (channels.findChannel(std::string(name))) names.emplace_back(name);
    for (auto it = channels.begin(); it != channels.end(); ++it)
        if (!std::ranges::count(kColor, std::string_view(it.name()))) names.emplace_back(it.name());
    return names;
}

SampleType check_channels(const std::string& path, const Imf::ChannelList& channels) {
    SampleType type = SampleType::kHalf;
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        const Imf::Channel& channel = it.channel();
        if (channel.type == Imf::UINT)
            throw Error(ErrorKind::kUnsupported, cat(path, ": channel ", printable(it.name()),
                                                     " holds integers, expected half or float"));
        if (channel.xSampling != 1 || channel.ySampling != 1)
            throw Error(ErrorKind::kUnsupported,
                        cat(path, ": channel ", printable(it.name()), " is subsampled"));
        if (channel.type == Imf::FLOAT) type = SampleType::kFloat;
    }
    return type;
}

void check_primaries(const std::string& path, const Imf::Header& header) {
    if (!Imf::hasChromaticities(header)) return;
    const Imf::Chromaticities is = Imf::chromaticities(header), expected;
    const Imath::V2f differences[] = {is.red - expected.red, is.green - expected.green,
                                      is.blue - expected.blue, is.white - expected.white};
    for (const Imath::V2f& d : differences)
        if (!(std::abs(d.x) < 0.005f && std::abs(d.y) < 0.005f))
            throw Error(
                ErrorKind::kUnsupported,
                cat(path, ": the EXR's primaries are not Rec.709's; convert it, or name its colour space"));
}

void check_part(const std::string& path, const Imf::Header& header, const ImageLimits& limits) {
    if (header.hasType() && Imf::isDeepData(header.type()))
        throw Error(ErrorKind::kUnsupported, cat(path, ": deep EXR images are not supported"));
    const auto channels = static_cast<std::int64_t>(channel_order(header.channels()).size());
    const Imath::Box2i &shown = header.displayWindow(), &stored = header.dataWindow();
    for (const Imath::Box2i* window : {&shown, &stored})
        check_size(path, length(window->min.x, window->max.x), length(window->min.y, window->max.y), channels,
                   limits);
    if (header.hasTileDescription()) {
        // OpenEXR holds a row of tiles.
        const Imf::TileDescription& tile = header.tileDescription();
        check_size(path, tile.xSize, tile.ySize, channels, limits);
        const std::int64_t row = (length(stored.min.x, stored.max.x) + tile.xSize) * tile.ySize;
        if (row > limits.max_pixels)
            throw Error(ErrorKind::kBadFile, cat(path, ": a row of the EXR's tiles has ", row,
                                                 " pixels, at most ", limits.max_pixels, " are read"));
    }
}

}  // namespace

DecodedPicture decode_exr(const PictureFile& picture) {
    const std::string& path = picture.path;
    make_attributes_opaque(path, picture.bytes);
    return translate_errors(ErrorKind::kBadFile, cat(path, ": cannot read the EXR"), [&] {
        MemoryInput stream(path.c_str(), picture.bytes);
        Imf::MultiPartInputFile file(stream, /*numThreads=*/0, /*reconstructChunkOffsetTable=*/false);
        const Imf::Header& header = file.header(0);
        check_part(path, header, picture.options.limits);
        if (!picture.options.color_space) check_primaries(path, header);

        const Imath::Box2i &shown = header.displayWindow(), &stored = header.dataWindow();
        DecodedPicture out;
        const std::vector<std::string> names = channel_order(header.channels());
        const SampleType type = check_channels(path, header.channels());
        const std::size_t channels = names.size();
        out.image = make_image(shown.max.x - shown.min.x + 1, shown.max.y - shown.min.y + 1,
                               static_cast<int>(channels));
        out.image.channel_names = names;
        out.image.sample_type = type;
        out.associated_alpha = true;

        // Reads row by row through one buffer as wide as the data window, which may be anywhere.
        const auto stored_width = static_cast<std::size_t>(length(stored.min.x, stored.max.x));
        std::vector<float> row(stored_width * channels);
        Imf::FrameBuffer buffer;
        // OpenEXR wants the address of pixel (0, 0), wherever the window is. The stride from row to row is 0.
        const std::size_t stride = channels * sizeof(float);
        const std::ptrdiff_t origin = std::ptrdiff_t{stored.min.x} * static_cast<std::ptrdiff_t>(stride);
        for (std::size_t c = 0; c < channels; ++c)
            buffer.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(row.data() + c) - origin,
                                               stride, 0));
        Imf::InputPart part(file, 0);
        part.setFrameBuffer(buffer);
        const int left = std::max(shown.min.x, stored.min.x), right = std::min(shown.max.x, stored.max.x);
        for (int y = stored.min.y; y <= stored.max.y; ++y) {
            part.readPixels(y);  // also the rows that are not shown: a truncated file is an error anywhere
            if (y < shown.min.y || y > shown.max.y || left > right) continue;
            const auto from = static_cast<std::size_t>(left - stored.min.x) * channels;
            const auto count = static_cast<std::size_t>(right - left + 1) * channels;
            std::copy_n(row.begin() + static_cast<std::ptrdiff_t>(from), count,
                        out.image.pixel(left - shown.min.x, y - shown.min.y));
        }
        return out;
    });
}

}  // namespace imgmesh
