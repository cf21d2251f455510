// Sources: "OpenEXR File Layout". OpenEXR writes the file; the blocks of pixels are packed here, on all
// threads and with libdeflate, in half the time of OpenEXR's own ZIP (docs/decisions/0016-fast-files.md).
#include <half.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "formats/exr/exr_layers.h"
#include "formats/exr/exr_output.h"
#include "formats/exr/exr_part_checks.h"
#include "formats/exr/zip_blocks.h"
#include "libcore/base/error.h"
#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kGroupBlocks = 128;  // packed at a time, before they are written in order

bool has_halves(const LayerView& part) {
    return part.map->precision == WeightPrecision::kHalf;
}

ExrPartHeader header_of(const LayerView& part) {
    ExrPartHeader header;
    header.name = part.name;
    header.data = header.shown = {0, 0, part.map->width - 1, part.map->height - 1};
    header.version = kLayersVersion;
    if (!part.topology.empty()) header.topology = part.topology;
    const ExrSample weight = has_halves(part) ? ExrSample::kHalf : ExrSample::kFloat;
    header.channels = {
        {kU, weight, 1, 1, true}, {kV, weight, 1, 1, true}, {kFace, ExrSample::kUint, 1, 1, true}};
    if (!part.visits.empty()) header.channels.push_back({kVisits, ExrSample::kUint, 1, 1, true});
    return header;
}

template <typename T>
void put(std::uint8_t*& out, T value) {
    std::memcpy(out, &value, sizeof value);
    out += sizeof value;
}

// Puts the rows [first, last) in a block's order: row by row, in each row channel by channel, sorted by name.
void fill_block(const LayerView& part, int first, int last, Bytes& block) {
    const bool halves = has_halves(part);
    const auto width = static_cast<std::size_t>(part.map->width);
    const std::size_t pixel_bytes = (halves ? 4 : 8) + 4 + (part.visits.empty() ? 0 : 4);
    block.resize(width * static_cast<std::size_t>(last - first) * pixel_bytes);
    std::uint8_t* out = block.data();
    for (int y = first; y < last; ++y) {
        const std::span<const PixelCoord> row = part.map->row(y);
        const auto weights = [&](float PixelCoord::*weight) {
            if (halves)
                for (const PixelCoord& c : row) put(out, half(c.*weight).bits());
            else
                for (const PixelCoord& c : row) put(out, c.*weight);
        };
        weights(&PixelCoord::u);
        weights(&PixelCoord::v);
        for (const PixelCoord& c : row) put(out, c.face);
        if (!part.visits.empty()) {
            std::memcpy(out, part.visits.data() + static_cast<std::size_t>(y) * width, width * sizeof(Id));
            out += width * sizeof(Id);
        }
    }
}

void write_part(ExrOutput& file, std::size_t index, const LayerView& part) {
    const int height = part.map->height, blocks = (height + kExrZipRows - 1) / kExrZipRows;
    std::array<Bytes, kGroupBlocks> packed;
    for (int group = 0; group < blocks; group += kGroupBlocks) {
        const int end = std::min(blocks, group + kGroupBlocks);
        parallel_blocks(group, end, 1, [&](int first, int last) {
            ZipPacker packer;
            Bytes block;
            for (int b = first; b < last; ++b) {
                fill_block(part, b * kExrZipRows, std::min(height, (b + 1) * kExrZipRows), block);
                packed[static_cast<std::size_t>(b - group)] = packer.pack(block);
            }
        });
        for (int b = group; b < end; ++b)
            file.write_block(index, b * kExrZipRows, packed[static_cast<std::size_t>(b - group)]);
    }
}

void check_writable(const LayerView& part) {
    const float step = has_halves(part) ? kHalfWeightStep : kFloatWeightStep;
    constexpr int kGrain = 64;
    parallel_blocks(0, part.map->height, kGrain, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (const PixelCoord& c : part.map->row(y))
                if (!in_simplex(c) || !on_grid(c, step) || (c.face == kNone && (c.u != 0 || c.v != 0)))
                    throw Error(ErrorKind::kInternal,
                                cat("cannot store the weights (", c.u, ",", c.v, ") of face ", c.face,
                                    ": outside the simplex or no multiples of ", step));
    });
}

}  // namespace

Bytes encode_exr_layers(const std::vector<LayerPart>& parts) {
    std::vector<LayerView> views;
    for (const LayerPart& part : parts) views.push_back({part.name, &part.map, part.visits, part.topology});
    return encode_exr_layers(views);
}

Bytes encode_exr_layers(const std::vector<LayerView>& parts) {
    for (const LayerView& part : parts) check_writable(part);
    Bytes bytes;
    ExrOutput file(bytes);
    for (const LayerView& part : parts) file.add_part(header_of(part));
    for (std::size_t i = 0; i < parts.size(); ++i) write_part(file, i, parts[i]);
    file.finish();
    return bytes;
}

}  // namespace imgmesh
