#include "formats/picture/decode/exr_picture.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>

#include <algorithm>
#include <optional>

#include "formats/files/library_error.h"
#include "formats/picture/color/primaries.h"
#include "formats/picture/decode/exr_chroma.h"
#include "formats/picture/decode/keep_channels.h"
#include "formats/picture/exr_facts.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Imath::Box2i;

std::int64_t side(int first, int last) {
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
                const ImageLimits& limits, const ImageLimits& tile_limits) {
    const Box2i &shown = header.displayWindow(), &stored = header.dataWindow();
    for (const Box2i* window : {&shown, &stored})
        check_size(path, side(window->min.x, window->max.x), side(window->min.y, window->max.y), channels,
                   limits);
    // OpenEXR holds a chunk of lines, or a tile, with all channels of the file.
    const ExrBlock block = exr_block(header);
    if (block.channels * block.width > std::int64_t{limits.max_channels} * limits.max_side)
        throw Error(ErrorKind::kBadFile, cat(path, ": the EXR has ", block.channels, " channels in rows of ",
                                             block.width, " pixels, more than imgmesh reads"));
    if (header.hasTileDescription()) check_block_size(path, block.width, block.height, channels, tile_limits);
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

// What the header says of an image of that size, whose samples are 0.
DecodedPicture blank(const Imf::MultiPartInputFile& file, const ExrChoice& choice,
                     const ReadImageOptions& options, int width, int height) {
    const Imf::Header& header = file.header(choice.part);
    DecodedPicture out;
    out.image = make_image(width, height, static_cast<int>(choice.channels.size()));
    out.image.channel_names.clear();
    for (const ExrChannel& channel : choice.channels) out.image.channel_names.push_back(channel.name);
    out.image.sample_type = sample_type(choice.channels);
    out.associated_alpha = true;
    out.has_layers = true;
    out.warnings = choice.warnings;
    if (choice.chosen) out.place = {exr_part_name(file, choice.part), choice.layer};
    out.primaries = primaries_of(header);

    // Numbers that are taken for another colour space have no primaries of their own.
    out.metadata = metadata_of(header, !options.color_space, out.warnings);

    const Box2i &shown = header.displayWindow(), &stored = header.dataWindow();
    if (!(shown.intersects(stored.min) && shown.intersects(stored.max)))
        out.warnings.emplace_back("pixels beyond its display window are left out");
    return out;
}

template <typename Work>
auto in_exr(const std::string& path, Work&& work) {
    return translate_errors(ErrorKind::kBadFile, cat(path, ": cannot read the EXR"),
                            std::forward<Work>(work));
}

}  // namespace

ExrPicture::ExrPicture(const std::string& path, Imf::IStream& stream, const ReadImageOptions& options,
                       const ImageLimits& limits)
    : path_(path), options_(options) {
    in_exr(path_, [&] {
        file_ = std::make_unique<Imf::MultiPartInputFile>(stream, /*numThreads=*/0,
                                                          /*reconstructChunkOffsetTable=*/false);
        choice_ = choose_exr(path_, *file_, options_);
        const Imf::Header& header = file_->header(choice_.part);
        check_part(path_, header, static_cast<std::int64_t>(choice_.channels.size()), limits,
                   options_.limits);
        if (!choice_.luma.empty()) check_exr_chroma(path_, header.channels(), choice_);
        shown_ = header.displayWindow();
        stored_ = header.dataWindow();
        block_ = exr_block(header);
    });
}

std::int64_t ExrPicture::block_count() const {
    const auto count = [](std::int64_t size, std::int64_t unit) { return (size + unit - 1) / unit; };
    return count(side(stored_.min.x, stored_.max.x), block_.width) *
           count(side(stored_.min.y, stored_.max.y), block_.height);
}

DecodedPicture ExrPicture::read(const PixelRect& area) {
    const auto beyond = [](int first, int end) { return static_cast<int>(std::int64_t{first} + end - 1); };
    const Imath::V2i first(shown_.min.x + area.left, shown_.min.y + area.top),
        last(beyond(shown_.min.x, area.right), beyond(shown_.min.y, area.bottom));
    return read_blocks(area, {{std::max(first.x, stored_.min.x), std::max(first.y, stored_.min.y)},
                              {std::min(last.x, stored_.max.x), std::min(last.y, stored_.max.y)}});
}

DecodedPicture ExrPicture::read_all() {
    return read_blocks({0, 0, width(), height()}, stored_);
}

DecodedPicture ExrPicture::read_blocks(const PixelRect& area, const Box2i& wanted) {
    return in_exr(path_, [&] {
        DecodedPicture out = blank(*file_, choice_, options_, area.width(), area.height());
        if (wanted.min.x > wanted.max.x || wanted.min.y > wanted.max.y) return out;
        if (!samples_) samples_ = std::make_unique<ExrSamples>(*file_, choice_);
        const std::vector<char> exact =
            samples_->read(wanted, {shown_.min.x + area.left, shown_.min.y + area.top}, out.image);
        check_integers(path_, choice_, exact, out);
        return out;
    });
}

DecodedPicture ExrPicture::zero_pixel() const {
    return in_exr(path_, [&] { return blank(*file_, choice_, options_, 1, 1); });
}

}  // namespace imgmesh
