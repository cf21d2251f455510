// Reads the EXR files of containers: parts of scanlines without compression, in ZIPS or in ZIP. Source:
// "OpenEXR File Layout".
#include "formats/exr/exr_input.h"

#include <algorithm>
#include <bit>
#include <string_view>

#include "formats/exr/exr_attributes.h"
#include "formats/exr/exr_part_checks.h"
#include "formats/files/byte_reader.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using View = std::span<const std::uint8_t>;

constexpr std::size_t kMaxName = 255;
constexpr int kMaxCorner = 1 << 29;  // of a window, and OpenEXR's is no larger: sizes do not overflow then

[[noreturn]] void broken(const std::string& what) {
    throw ExrDataError(what);
}

std::string_view name_from(ByteReader& in) {
    const auto name = in.terminated_text(kMaxName);
    if (!name) broken("a name does not end");
    return *name;
}

int signed_number(ByteReader& in) {
    return static_cast<int>(in.number(4));
}

ExrWindow window_from(ByteReader& in) {
    ExrWindow w;
    for (int* const corner : {&w.min_x, &w.min_y, &w.max_x, &w.max_y}) {
        *corner = signed_number(in);
        if (*corner < -kMaxCorner || *corner > kMaxCorner) broken("a window is too large");
    }
    if (w.max_x < w.min_x || w.max_y < w.min_y) broken("a window is empty");
    return w;
}

std::vector<ExrPartChannel> channels_from(ByteReader& in) {
    std::vector<ExrPartChannel> channels;
    while (!in.take_if(0)) {
        ExrPartChannel c;
        c.name = name_from(in);
        const std::uint32_t type = in.number(4);
        if (type > static_cast<std::uint32_t>(ExrSample::kFloat)) broken("a channel of an unknown type");
        c.type = static_cast<ExrSample>(type);
        c.is_linear = in.number(1) != 0;
        in.take(3);
        c.x_sampling = signed_number(in);
        c.y_sampling = signed_number(in);
        // Blocks have their rows in this order.
        if (!channels.empty() && channels.back().name >= c.name) broken("the channels are not sorted");
        channels.push_back(std::move(c));
    }
    return channels;
}

struct Header {
    ExrPartHeader part;
    bool has_data = false, has_shown = false, has_compression = false;
};

void take_attribute(std::string_view name, std::string_view type, View value, Header& header) {
    ByteReader in(value, ByteOrder::kLittle);
    ExrPartHeader& part = header.part;
    if (type == "string") {
        const std::string text(text_of(value));
        if (name == "name") part.name = text;
        if (name == "type") part.type = text;
        if (name == kVersionName) part.version = text;
        if (name == kTopologyName) part.topology = text;
    } else if (type == "chlist" && name == "channels") {
        part.channels = channels_from(in);
    } else if (type == "box2i" && name == "dataWindow") {
        part.data = window_from(in);
        header.has_data = true;
    } else if (type == "box2i" && name == "displayWindow") {
        part.shown = window_from(in);
        header.has_shown = true;
    } else if (type == "compression" && name == "compression") {
        part.compression = static_cast<int>(in.number(1));
        header.has_compression = true;
    } else if (type == "tiledesc" && name == "tiles") {
        ExrTiles tiles{in.number(4), in.number(4), false};
        tiles.has_one_level = (in.number(1) & 15) == 0;
        part.tiles = tiles;
    }
}

// Returns nothing for the empty header that ends a list.
std::optional<Header> header_from(ByteReader& in) {
    Header header;
    bool empty = true;
    for (; !in.take_if(0); empty = false) {
        const std::string_view name = name_from(in), type = name_from(in);
        take_attribute(name, type, in.take(in.number(4)), header);
    }
    if (empty) return {};
    if (!header.has_data || !header.has_shown || !header.has_compression || header.part.channels.empty())
        broken("a header lacks its windows, compression or channels");
    return header;
}

int block_rows(const ExrPartHeader& part) {
    return part.compression == kExrZip ? kExrZipRows : 1;
}

}  // namespace

class ExrInput::File {
  public:
    File(View bytes, std::vector<ExrPartHeader>& parts) : bytes_(bytes), parts_(parts) {
        try {
            open();
        } catch (const EndOfBytes&) {
            broken("the file ends in its header");
        }
    }

    View block(std::size_t part, int row) const {
        try {
            return find_block(part, row);
        } catch (const EndOfBytes&) {
            broken(cat("the file ends in the block of row ", row));
        }
    }

  private:
    void open() {
        ByteReader in(bytes_, ByteOrder::kLittle);
        in.take(4);  // the signature
        const std::uint32_t field = in.number(4);
        many_ = (field & kExrMultiPart) != 0;
        while (const std::optional<Header> header = header_from(in)) {
            parts_.push_back(header->part);
            if (!many_) break;
        }
        if (parts_.empty()) broken("there is no part");
        if (!many_ && (field & kExrTiled) && !parts_[0].tiles) broken("a tiled file without tiles");
        // Of other parts the place of the next table is not known; they are refused by their headers alone.
        std::size_t at = in.position();
        for (const ExrPartHeader& part : parts_) {
            tables_.push_back(at);
            const auto rows = static_cast<std::size_t>(part.data.max_y - part.data.min_y + 1),
                       block = static_cast<std::size_t>(block_rows(part));
            at += 8 * ((rows + block - 1) / block);
        }
    }

    View find_block(std::size_t part, int row) const {
        const std::size_t number = static_cast<std::size_t>(row / block_rows(parts_[part]));
        ByteReader table(tail(tables_[part] + 8 * number), ByteOrder::kLittle);
        const std::uint64_t low = table.number(4), offset = low | std::uint64_t{table.number(4)} << 32;
        if (offset > bytes_.size()) throw EndOfBytes{bytes_.size()};
        ByteReader in(tail(static_cast<std::size_t>(offset)), ByteOrder::kLittle);
        const bool of_part = !many_ || in.number(4) == part;
        const bool of_row = signed_number(in) == row + parts_[part].data.min_y;
        if (!of_part || !of_row) broken(cat("there is no block of row ", row));
        return in.take(in.number(4));
    }

    View tail(std::size_t at) const {
        if (at > bytes_.size()) throw EndOfBytes{bytes_.size()};
        return bytes_.subspan(at);
    }

    View bytes_;
    std::vector<ExrPartHeader>& parts_;
    std::vector<std::size_t> tables_;  // of the blocks' places, where each part's begins
    bool many_ = false;
};

ExrInput::ExrInput(View bytes) {
    file_ = std::make_unique<File>(bytes, parts_);  // once there are parts_ to fill
}
ExrInput::~ExrInput() = default;

View ExrInput::block(std::size_t part, int row) {
    return file_->block(part, row);
}

void ExrInput::read_tiles(std::size_t, LayerPart&) {
    broken("it has tiles, which only imgmesh's programs read; they write it in scanlines");
}

}  // namespace imgmesh
