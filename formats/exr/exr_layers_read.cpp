#include "formats/exr/exr_layers.h"

#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "formats/exr/exr_header.h"
#include "formats/exr/exr_input.h"
#include "formats/exr/exr_part_checks.h"
#include "formats/exr/zip_blocks.h"
#include "formats/files/one_line.h"
#include "formats/findings/findings.h"
#include "libcore/base/error.h"
#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

// Deflate never packs more than this many bytes into one.
constexpr std::uint64_t kMaxDeflateRatio = 1032;

template <typename T>
T take(const std::uint8_t*& in) {
    T value;
    std::memcpy(&value, in, sizeof value);
    in += sizeof value;
    return value;
}

// Reads the rows from `first` on from their block: row by row, in each row channel by channel, sorted by
// name.
void spread_block(const std::vector<ExrPartChannel>& channels, const std::vector<std::uint8_t>& block,
                  int first, int last, LayerPart& part) {
    const std::uint8_t* in = block.data();
    for (int y = first; y < last; ++y)
        for (const ExrPartChannel& channel : channels) {
            const std::string& name = channel.name;
            const std::span<PixelCoord> row = part.map.row(y);
            if (name == kVisits || name == kFace) {
                Id* visits =
                    name == kVisits ? part.visits.data() + static_cast<std::size_t>(y) * row.size() : nullptr;
                for (PixelCoord& c : row) (visits ? *visits++ : c.face) = take<Id>(in);
                continue;
            }
            float PixelCoord::*const weight = name == kU ? &PixelCoord::u : &PixelCoord::v;
            if (channel.type == ExrSample::kHalf)
                for (PixelCoord& c : row) {
                    half value;
                    value.setBits(take<std::uint16_t>(in));
                    c.*weight = value;
                }
            else
                for (PixelCoord& c : row) c.*weight = take<float>(in);
        }
}

// The file finds the blocks and checks their lengths; all threads unpack them. The compression is one of
// those that check_part_header() allows.
void read_scanlines(ExrInput& file, std::size_t index, LayerPart& part) {
    constexpr int kGroupBlocks = 128;  // read at a time, before they are unpacked
    const ExrPartHeader& header = file.parts()[index];
    const int rows = header.compression == kExrZip ? kExrZipRows : 1, height = part.map.height,
              blocks = (height + rows - 1) / rows;
    std::size_t row_bytes = 0;
    for (const ExrPartChannel& channel : header.channels)
        row_bytes +=
            static_cast<std::size_t>(part.map.width) * static_cast<std::size_t>(sample_bytes(channel.type));
    std::vector<std::vector<std::uint8_t>> packed(static_cast<std::size_t>(std::min(blocks, kGroupBlocks)));
    for (int group = 0; group < blocks; group += kGroupBlocks) {
        const int end = std::min(blocks, group + kGroupBlocks);
        for (int b = group; b < end; ++b) {
            const std::span<const std::uint8_t> bytes = file.block(index, b * rows);
            packed[static_cast<std::size_t>(b - group)].assign(bytes.begin(), bytes.end());
        }
        parallel_blocks(group, end, std::max(1, 16 / rows), [&](int first, int last) {
            ZipUnpacker unpacker;
            std::vector<std::uint8_t> block;
            for (int b = first; b < last; ++b) {
                const int top = b * rows, bottom = std::min(height, top + rows);
                block.resize(row_bytes * static_cast<std::size_t>(bottom - top));
                if (!unpacker.unpack(packed[static_cast<std::size_t>(b - group)], block))
                    throw ExrDataError(cat("the block of row ", top, " cannot be unpacked"));
                spread_block(header.channels, block, top, bottom, part);
            }
        });
    }
}

LayerPart read_part(ExrInput& file, std::size_t index, const ExpectedLayers& expected, std::size_t which,
                    Findings& findings) {
    const ExrPartHeader& header = file.parts()[index];
    const std::size_t pixels =
        static_cast<std::size_t>(expected.width) * static_cast<std::size_t>(expected.height);
    LayerPart part{
        expected.parts[which], {expected.width, expected.height, {}, WeightPrecision::kFloat}, {}, {}};
    part.map.values.resize(pixels);
    if (header.channel(kVisits)) part.visits.resize(pixels);
    if (header.topology)
        part.topology = *header.topology;
    else
        findings.add("layers.unbound", cat("part ", part.name, " has no ", kTopologyName),
                     at_part(part.name));
    if (header.tiles)
        file.read_tiles(index, part);
    else
        read_scanlines(file, index, part);
    const bool stored_as_half =
        header.channel(kU)->type == ExrSample::kHalf && header.channel(kV)->type == ExrSample::kHalf;
    finish_part(part, stored_as_half, expected.faces[which], expected.has_mask, findings);
    return part;
}

std::vector<LayerPart> read_parts(std::span<const std::uint8_t> bytes, const ExpectedLayers& expected,
                                  Findings& findings) {
    ExrInput file(bytes);
    const std::vector<ExrPartHeader>& headers = file.parts();
    if (headers.size() != expected.parts.size())
        refuse("layers.parts",
               cat("the EXR has ", headers.size(), " parts, expected ", expected.parts.size()));
    const std::optional<std::string>& version = headers[0].version;
    if (!version || !version->starts_with("1."))
        findings.add("layers.version",
                     cat(kVersionName, " is ", version ? *version : "missing", ", expected 1.x"));
    std::vector<LayerPart> parts(expected.parts.size());
    for (std::size_t which = 0; which < expected.parts.size(); ++which) {
        const std::string& name = expected.parts[which];
        parts[which].name = name;
        const auto index = static_cast<std::size_t>(
            std::ranges::find_if(headers, [&](const ExrPartHeader& h) { return h.name == name; }) -
            headers.begin());
        if (index == headers.size()) {
            findings.add("layers.parts", cat("the EXR has no part ", name), at_part(name));
            continue;
        }
        const std::size_t before = findings.errors();
        check_part_header(headers[index], name, expected, findings);
        if (findings.errors() > before) continue;
        try {
            LayerPart part = read_part(file, index, expected, which, findings);
            if (findings.errors() == before) parts[which] = std::move(part);
        } catch (const ExrDataError& error) {
            findings.add("layers.data", cat("OpenEXR cannot read part ", name, ": ", error.what()),
                         at_part(name));
        }
    }
    return parts;
}

}  // namespace

std::vector<LayerPart> decode_exr_layers(std::span<const std::uint8_t> bytes, const ExpectedLayers& expected,
                                         Findings& findings) {
    check_exr_header(bytes, static_cast<int>(expected.parts.size()));
    // An id and two halves are 8 bytes a pixel. This bounds all memory by the bytes that are really there.
    const std::uint64_t pixel_bytes = 8 * static_cast<std::uint64_t>(expected.width) *
                                      static_cast<std::uint64_t>(expected.height) * expected.parts.size();
    if (pixel_bytes / kMaxDeflateRatio > bytes.size())
        refuse("layers.size", cat("the EXR has ", bytes.size(), " bytes, too few for ", expected.parts.size(),
                                  " levels of ", expected.width, "x", expected.height, " pixels"));
    try {
        return read_parts(bytes, expected, findings);
    } catch (const FindingError&) {
        throw;
    } catch (const std::exception& error) {  // OpenEXR's own, and what std containers throw for its sizes
        refuse("layers.data", cat("OpenEXR cannot read the layers: ", one_line(error.what())));
    }
}

std::vector<LayerPart> decode_exr_layers(std::span<const std::uint8_t> bytes,
                                         const ExpectedLayers& expected) {
    Findings findings = Findings::strict();
    return decode_exr_layers(bytes, expected, findings);
}

}  // namespace imgmesh
