// Reads the strips or tiles of a TIFF, each once, into the samples of the whole image.
#include <algorithm>

#include "formats/picture/decode/tiff_samples.h"
#include "libcore/base/parallel_vector.h"

namespace imgmesh {
namespace {

std::size_t as_size(std::int64_t n) {
    return static_cast<std::size_t>(n);
}
std::int64_t rounded_up(std::int64_t n, std::int64_t unit) {
    return (n + unit - 1) / unit;
}

// A strip or a tile: the pixels [x, x + columns) x [y, y + rows) of the image.
struct Block {
    std::uint32_t index;
    std::int64_t x, y, columns, rows;
    int sample;  ///< the first
};

class BlockReader {
  public:
    BlockReader(TiffFile& file, const TiffLayout& layout, std::optional<float> fill, std::vector<float>& out)
        : file_(file), layout_(layout), fill_(fill), out_(out) {}

    void read(const Block& block) {
        std::uint64_t stored_rows = as_size(layout_.tiled ? layout_.block_height : block.rows);
        const std::size_t wanted = block_bytes(stored_rows);
        if (is_left_out(block.index)) {
            for (std::int64_t y = 0; y < block.rows; ++y) fill_row(block, y);
            return;
        }
        const std::uint64_t theirs =
            layout_.tiled ? TIFFTileSize64(file_.get())
                          : TIFFVStripSize64(file_.get(), static_cast<std::uint32_t>(stored_rows));
        if (theirs != wanted)
            throw file_.broken(
                cat("the TIFF's block ", block.index, " has ", theirs, " bytes, expected ", wanted));
        buffer_.resize(wanted);
        const auto size = static_cast<tmsize_t>(wanted);
        const tmsize_t got = layout_.tiled
                                 ? TIFFReadEncodedTile(file_.get(), block.index, buffer_.data(), size)
                                 : TIFFReadEncodedStrip(file_.get(), block.index, buffer_.data(), size);
        if (got != size) throw file_.broken(cat("the TIFF is broken or truncated in block ", block.index));
        for (std::int64_t y = 0; y < block.rows; ++y)
            is_subsampled() ? unpack_chroma_row(block, y) : unpack_row(block, y);
    }

  private:
    bool is_subsampled() const { return layout_.chroma_x > 1 || layout_.chroma_y > 1; }
    int samples_of_block() const { return layout_.planar ? 1 : layout_.samples; }
    std::size_t row_bytes() const {
        return as_size(rounded_up(layout_.block_width * samples_of_block() * layout_.bits, 8));
    }
    // Subsampled: for each group of pixels all their Y, then Cb and Cr (TIFF 6.0, section 21).
    std::size_t group_bytes() const { return as_size(layout_.chroma_x * layout_.chroma_y + 2); }
    std::size_t group_row_bytes() const {
        return as_size(rounded_up(layout_.block_width, layout_.chroma_x)) * group_bytes();
    }
    std::size_t block_bytes(std::uint64_t rows) const {
        if (!is_subsampled()) return row_bytes() * rows;
        return group_row_bytes() * as_size(rounded_up(static_cast<std::int64_t>(rows), layout_.chroma_y));
    }

    bool is_left_out(std::uint32_t index) const {
        if (!fill_) return false;
        return TIFFGetStrileOffset(file_.get(), index) == 0 &&
               TIFFGetStrileByteCount(file_.get(), index) == 0;
    }

    float* place(const Block& block, std::int64_t row) {
        const std::int64_t pixel = (block.y + row) * layout_.width + block.x;
        return out_.data() + as_size(pixel * layout_.samples + block.sample);
    }

    void fill_row(const Block& block, std::int64_t row) {
        float* out = place(block, row);
        for (std::int64_t x = 0; x < block.columns; ++x, out += layout_.samples)
            std::fill_n(out, samples_of_block(), *fill_);
    }

    void unpack_row(const Block& block, std::int64_t row) {
        const std::span<const std::uint8_t> bytes(buffer_.data() + as_size(row) * row_bytes(), row_bytes());
        const auto count = as_size(block.columns * samples_of_block());
        unpack_samples(bytes, count, layout_.kind, layout_.bits, place(block, row),
                       layout_.planar ? as_size(layout_.samples) : 1);
    }

    void unpack_chroma_row(const Block& block, std::int64_t row) {
        const int wide = layout_.chroma_x, high = layout_.chroma_y;
        const std::uint8_t* groups = buffer_.data() + as_size(row / high) * group_row_bytes();
        float* out = place(block, row);
        for (std::int64_t x = 0; x < block.columns; ++x, out += layout_.samples) {
            const std::uint8_t* group = groups + as_size(x / wide) * group_bytes();
            out[0] = group[as_size((row % high) * wide + x % wide)];
            out[1] = group[wide * high];
            out[2] = group[wide * high + 1];
        }
    }

    TiffFile& file_;
    const TiffLayout& layout_;
    std::optional<float> fill_;
    std::vector<float>& out_;
    std::vector<std::uint8_t> buffer_;
};

// Every block is where the file has bytes, so that none of the pixels' memory is taken for a file without.
void check_blocks(const TiffFile& file, const TiffLayout& layout, bool may_leave_out) {
    const std::int64_t planes = layout.planar ? layout.samples : 1;
    const std::int64_t blocks = planes * rounded_up(layout.width, layout.block_width) *
                                rounded_up(layout.height, layout.block_height);
    const std::uint32_t count = layout.tiled ? TIFFNumberOfTiles(file.get()) : TIFFNumberOfStrips(file.get());
    if (count != blocks)
        throw file.broken(cat("the TIFF has ", count, " strips or tiles, expected ", blocks));
    const std::uint64_t size = file.bytes().size();
    // Old-style JPEG is one stream, whatever the strips are.
    if (file.tag<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_OJPEG) return;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint64_t at = TIFFGetStrileOffset(file.get(), i),
                            bytes = TIFFGetStrileByteCount(file.get(), i);
        if (at == 0 && bytes == 0 && may_leave_out) continue;
        if (bytes == 0 || at >= size || bytes > size - at)
            throw file.broken(cat("the TIFF is broken or truncated: block ", i, " has ", bytes, " bytes at ",
                                  at, " in a file of ", size));
    }
}

}  // namespace

std::vector<float> read_samples(TiffFile& file, const TiffLayout& layout, std::optional<float> fill) {
    check_blocks(file, layout, fill.has_value());
    std::vector<float> out =
        parallel_vector<float>(as_size(layout.width) * as_size(layout.height) * as_size(layout.samples));
    BlockReader reader(file, layout, fill, out);
    file.forget_messages();
    std::uint32_t index = 0;  // blocks are counted along rows, plane after plane
    for (int sample = 0; sample < (layout.planar ? layout.samples : 1); ++sample)
        for (std::int64_t y = 0; y < layout.height; y += layout.block_height)
            for (std::int64_t x = 0; x < layout.width; x += layout.block_width)
                reader.read({index++, x, y, std::min(layout.block_width, layout.width - x),
                             std::min(layout.block_height, layout.height - y), sample});
    // Some codecs only warn of pixels that are missing, and make them up.
    for (const std::string& warning : file.warnings())
        if (warning.find("remature") != std::string::npos)
            throw file.broken(cat("the TIFF is truncated: ", warning));
    return out;
}

}  // namespace imgmesh
