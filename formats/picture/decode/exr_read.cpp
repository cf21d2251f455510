// EXR images through OpenEXR itself: OpenImageIO's reader can abort on a corrupt file.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <bit>
#include <optional>

#include "formats/exr/exr_opaque.h"
#include "formats/exr/memory_input.h"
#include "formats/files/library_error.h"
#include "formats/picture/color/primaries.h"
#include "formats/picture/decode/exr_choice.h"
#include "formats/picture/decode/exr_chroma.h"
#include "formats/picture/decode/keep_channels.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/exr_facts.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

std::int64_t length(int first, int last) {
    return std::int64_t{last} - first + 1;
}

std::optional<Primaries> primaries_of(const Imf::Header& header) {
    const auto values = [](const Imf::Chromaticities& is) {
        const auto point = [](const Imath::V2f& v) { return Chromaticity{v.x, v.y}; };
        return Primaries{point(is.red), point(is.green), point(is.blue), point(is.white)};
    };
    if (Imf::hasChromaticities(header)) return values(Imf::chromaticities(header));
    // SMPTE ST 2065-4 has only one space.
    const auto* const aces = header.findTypedAttribute<Imf::IntAttribute>("acesImageContainerFlag");
    if (aces && aces->value() == 1) return kAcesPrimaries;
    return {};
}

void check_part(const std::string& path, const Imf::Header& header, std::int64_t channels,
                const ImageLimits& limits) {
    const Imath::Box2i &shown = header.displayWindow(), &stored = header.dataWindow();
    for (const Imath::Box2i* window : {&shown, &stored})
        check_size(path, length(window->min.x, window->max.x), length(window->min.y, window->max.y), channels,
                   limits);
    // OpenEXR holds a block of rows, or a row of tiles, with all channels of the file.
    std::int64_t all = 0;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) ++all;
    const std::int64_t width = length(stored.min.x, stored.max.x);
    if (all * width > std::int64_t{limits.max_channels} * limits.max_side)
        throw Error(ErrorKind::kBadFile, cat(path, ": the EXR has ", all, " channels in rows of ", width,
                                             " pixels, more than imgmesh reads"));
    if (header.hasTileDescription()) {
        const Imf::TileDescription& tile = header.tileDescription();
        check_block_size(path, tile.xSize, tile.ySize, channels, limits);
        const std::int64_t row = (width + tile.xSize) * tile.ySize;
        if (row > limits.max_pixels)
            throw Error(ErrorKind::kBadFile, cat(path, ": a row of the EXR's tiles has ", row,
                                                 " pixels, at most ", limits.max_pixels, " are read"));
    }
}

// Where rows of the data window go in the image, which is the display window.
class Windows {
  public:
    explicit Windows(const Imf::Header& header)
        : stored(header.dataWindow()), shown_(header.displayWindow()) {}

    // Calls set(from, to) with the index of each pixel of row y that is shown and its place in `image`.
    template <typename Set>
    void copy_row(int y, Image& image, const Set& set) const {
        if (y < shown_.min.y || y > shown_.max.y) return;
        const int right = std::min(shown_.max.x, stored.max.x);
        for (int x = std::max(shown_.min.x, stored.min.x); x <= right; ++x)
            set(static_cast<std::size_t>(std::int64_t{x} - stored.min.x),
                image.pixel(x - shown_.min.x, y - shown_.min.y));
    }

    const Imath::Box2i stored;

  private:
    const Imath::Box2i shown_;
};

// A row of each channel: the bits of floats, or integers.
using Rows = std::vector<std::vector<std::uint32_t>>;

Imf::FrameBuffer row_buffer(const std::vector<ExrChannel>& channels, const Imath::Box2i& stored, Rows& rows) {
    Imf::FrameBuffer buffer;
    for (const ExrChannel& channel : channels) {
        rows.emplace_back(
            channel.full.empty() ? 0 : static_cast<std::size_t>(length(stored.min.x, stored.max.x)));
        if (channel.full.empty()) continue;
        // OpenEXR wants the address of pixel (0, 0), wherever the window is. The stride from row to row is 0.
        constexpr auto kStride = static_cast<std::ptrdiff_t>(sizeof(std::uint32_t));
        buffer.insert(
            channel.full,
            Imf::Slice(channel.type == Imf::UINT ? Imf::UINT : Imf::FLOAT,
                       reinterpret_cast<char*>(rows.back().data()) - kStride * stored.min.x, kStride, 0));
    }
    return buffer;
}

// Reads the channels that the file has. Returns for each whether all its numbers are floats exactly.
std::vector<char> read_channels(Imf::InputPart& part, const std::vector<ExrChannel>& channels,
                                const Windows& windows, Image& image) {
    constexpr std::uint32_t kExact = 1u << 24;
    std::vector<char> exact(channels.size(), 1);
    Rows rows;
    const Imf::FrameBuffer buffer = row_buffer(channels, windows.stored, rows);
    if (buffer.begin() == buffer.end()) return exact;
    part.setFrameBuffer(buffer);
    for (int y = windows.stored.min.y; y <= windows.stored.max.y; ++y) {
        part.readPixels(y);  // also the rows that are not shown: a truncated file is an error anywhere
        for (std::size_t c = 0; c < channels.size(); ++c) {
            if (channels[c].full.empty()) continue;
            const bool integers = channels[c].type == Imf::UINT;
            windows.copy_row(y, image, [&](std::size_t from, float* to) {
                const std::uint32_t bits = rows[c][from];
                to[c] = integers ? static_cast<float>(bits) : std::bit_cast<float>(bits);
                if (integers && bits >= kExact) exact[c] = 0;
            });
        }
    }
    return exact;
}

void read_colors(const std::string& path, Imf::InputPart& part, const ExrChoice& choice,
                 const Windows& windows, Image& image) {
    constexpr const char* kNames[] = {"R", "G", "B"};
    read_exr_chroma(path, part, choice, [&](int y, const float* rgb) {
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t c = 0; c < choice.channels.size(); ++c)
                if (choice.channels[c].full.empty() && choice.channels[c].name == kNames[k])
                    windows.copy_row(y, image,
                                     [&](std::size_t from, float* to) { to[c] = rgb[3 * from + k]; });
    });
}

// Refuses integers that floats do not hold, or leaves their channel out.
void check_integers(const std::string& path, const ExrChoice& choice, const std::vector<char>& exact,
                    DecodedPicture& out) {
    std::vector<char> keep(exact.size(), 1);
    for (std::size_t c = 0; c < exact.size(); ++c) {
        if (exact[c]) continue;
        const ExrChannel& channel = choice.channels[c];
        const std::string what = "holds integers of 2^24 and more, which floats cannot hold";
        if (channel.required || exact.size() == 1)
            throw Error(ErrorKind::kUnsupported, cat(path, ": channel ", printable(channel.full), " ", what));
        keep[c] = 0;
        out.warnings.push_back(cat("channel ", printable(channel.full), " is left out: it ", what));
    }
    keep_channels(out.image, keep);
}

SampleType sample_type(const std::vector<ExrChannel>& channels) {
    return std::ranges::all_of(channels, [](const ExrChannel& c) { return c.type == Imf::HALF; })
               ? SampleType::kHalf
               : SampleType::kFloat;
}

}  // namespace

DecodedPicture decode_exr(const PictureFile& picture) {
    const std::string& path = picture.path;
    make_attributes_opaque(path, picture.bytes);
    return translate_errors(ErrorKind::kBadFile, cat(path, ": cannot read the EXR"), [&] {
        MemoryInput stream(path.c_str(), picture.bytes);
        Imf::MultiPartInputFile file(stream, /*numThreads=*/0, /*reconstructChunkOffsetTable=*/false);
        const ExrChoice choice = choose_exr(path, file, picture.options);
        const Imf::Header& header = file.header(choice.part);
        const std::vector<ExrChannel>& channels = choice.channels;
        check_part(path, header, static_cast<std::int64_t>(channels.size()), picture.options.limits);

        const Imath::Box2i& shown = header.displayWindow();
        DecodedPicture out;
        out.image = make_image(shown.max.x - shown.min.x + 1, shown.max.y - shown.min.y + 1,
                               static_cast<int>(channels.size()));
        out.image.channel_names.clear();
        for (const ExrChannel& channel : channels) out.image.channel_names.push_back(channel.name);
        out.image.sample_type = sample_type(channels);
        out.associated_alpha = true;
        out.has_layers = true;
        out.warnings = choice.warnings;
        if (choice.chosen) out.place = {exr_part_name(file, choice.part), choice.layer};
        out.primaries = primaries_of(header);

        // Numbers that are taken for another colour space have no primaries of their own.
        out.metadata = metadata_of(header, !picture.options.color_space, out.warnings);

        const Imath::Box2i& stored = header.dataWindow();
        if (!(shown.intersects(stored.min) && shown.intersects(stored.max)))
            out.warnings.emplace_back("pixels beyond its display window are left out");

        const Windows windows(header);
        Imf::InputPart part(file, choice.part);
        const std::vector<char> exact = read_channels(part, channels, windows, out.image);
        if (!choice.luma.empty()) read_colors(path, part, choice, windows, out.image);
        check_integers(path, choice, exact, out);
        return out;
    });
}

}  // namespace imgmesh
