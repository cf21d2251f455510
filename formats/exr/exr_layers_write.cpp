// Sources: "OpenEXR File Layout". OpenEXR writes the file; the blocks of pixels are packed here, on all
// threads and with libdeflate, in half the time of OpenEXR's own ZIP (docs/decisions/0016-fast-files.md).
#include <half.h>
#include <openexr.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "formats/exr/exr_layers.h"
#include "formats/exr/exr_part_checks.h"
#include "formats/exr/zip_blocks.h"
#include "libcore/base/error.h"
#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kBlockRows = 16;     // of ZIP
constexpr int kGroupBlocks = 128;  // packed at a time, before they are written in order

void check(exr_result_t result) {
    if (result != EXR_ERR_SUCCESS)
        throw Error(ErrorKind::kInternal,
                    cat("OpenEXR cannot encode the layers: ", exr_get_default_error_message(result)));
}

// OpenEXR also returns its errors as results; its handler would print them.
void say_nothing(exr_const_context_t, exr_result_t, const char*) {}

std::int64_t write_to_memory(exr_const_context_t context, void* target, const void* data, std::uint64_t size,
                             std::uint64_t offset, exr_stream_error_func_ptr_t error) {
    auto& bytes = *static_cast<Bytes*>(target);
    try {
        if (offset + size > bytes.size()) bytes.resize(offset + size);
    } catch (const std::bad_alloc&) {
        error(context, EXR_ERR_OUT_OF_MEMORY, "out of memory");
        return -1;
    }
    std::memcpy(bytes.data() + offset, data, size);
    return static_cast<std::int64_t>(size);
}

// A file that OpenEXR writes to memory.
class ExrFile {
  public:
    explicit ExrFile(Bytes& bytes) {
        exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
        start.error_handler_fn = say_nothing;
        start.user_data = &bytes;
        start.write_fn = write_to_memory;
        check(exr_start_write(&context_, "layers", EXR_WRITE_FILE_DIRECTLY, &start));
    }
    ~ExrFile() {
        if (context_) exr_finish(&context_);
    }
    ExrFile(const ExrFile&) = delete;
    ExrFile& operator=(const ExrFile&) = delete;

    exr_context_t get() const { return context_; }
    /// Writes the tables of blocks.
    void finish() { check(exr_finish(&context_)); }

  private:
    exr_context_t context_ = nullptr;
};

bool has_halves(const LayerView& part) {
    return part.map->precision == WeightPrecision::kHalf;
}

void add_part(exr_context_t file, const LayerView& part) {
    int index = 0;
    check(exr_add_part(file, part.name.c_str(), EXR_STORAGE_SCANLINE, &index));
    check(exr_initialize_required_attr_simple(file, index, part.map->width, part.map->height,
                                              EXR_COMPRESSION_ZIP));
    check(exr_attr_set_string(file, index, kVersionName, kLayersVersion));
    if (!part.topology.empty()) check(exr_attr_set_string(file, index, kTopologyName, part.topology.c_str()));
    const auto add = [&](const char* name, exr_pixel_type_t type) {
        check(exr_add_channel(file, index, name, type, EXR_PERCEPTUALLY_LINEAR, 1, 1));
    };
    const exr_pixel_type_t weight = has_halves(part) ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    add(kU, weight);
    add(kV, weight);
    add(kFace, EXR_PIXEL_UINT);
    if (!part.visits.empty()) add(kVisits, EXR_PIXEL_UINT);
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

void write_part(exr_context_t file, int index, const LayerView& part) {
    const int height = part.map->height, blocks = (height + kBlockRows - 1) / kBlockRows;
    std::array<Bytes, kGroupBlocks> packed;
    for (int group = 0; group < blocks; group += kGroupBlocks) {
        const int end = std::min(blocks, group + kGroupBlocks);
        parallel_blocks(group, end, 1, [&](int first, int last) {
            ZipPacker packer;
            Bytes block;
            for (int b = first; b < last; ++b) {
                fill_block(part, b * kBlockRows, std::min(height, (b + 1) * kBlockRows), block);
                packed[static_cast<std::size_t>(b - group)] = packer.pack(block);
            }
        });
        for (int b = group; b < end; ++b) {
            const Bytes& bytes = packed[static_cast<std::size_t>(b - group)];
            check(exr_write_scanline_chunk(file, index, b * kBlockRows, bytes.data(), bytes.size()));
        }
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
    ExrFile file(bytes);
    for (const LayerView& part : parts) add_part(file.get(), part);
    check(exr_write_header(file.get()));
    for (std::size_t i = 0; i < parts.size(); ++i) write_part(file.get(), static_cast<int>(i), parts[i]);
    file.finish();
    return bytes;
}

}  // namespace imgmesh
