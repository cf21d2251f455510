// Reads strips or tiles of a TIFF, each once, into the samples of an area.
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

// A strip or a tile. Its first pixel is (x, y) of the image, and it has so many rows in the file.
struct Block {
    std::uint32_t index;
    std::int64_t x, y, rows;
    int sample;  ///< the first
};

// Calls use(block) for those that the area touches. They are counted along rows, plane after plane.
template <typename Use>
void for_blocks(const TiffLayout& layout, const PixelRect& area, const Use& use) {
    const std::int64_t wide = layout.block_width, high = layout.block_height;
    for (int plane = 0; plane < (layout.planar ? layout.samples : 1); ++plane)
        for (std::int64_t row = area.top / high; row * high < area.bottom; ++row)
            for (std::int64_t column = area.left / wide; column * wide < area.right; ++column) {
                const std::int64_t index =
                    (plane * layout.blocks_down() + row) * layout.blocks_across() + column;
                const std::int64_t rows = layout.tiled ? high : std::min(high, layout.height - row * high);
                use(Block{static_cast<std::uint32_t>(index), column * wide, row * high, rows, plane});
            }
}

class BlockReader {
  public:
    BlockReader(TiffFile& file, const TiffLayout& layout, const PixelRect& area, std::optional<float> fill,
                std::vector<float>& out)
        : file_(file), layout_(layout), area_(area), fill_(fill), out_(out) {}

    // Reads strips by their rows, of which no more than one is held.
    void read_rows(TiffRows& rows) {
        buffer_.resize(rows.row_bytes());
        for (int plane = 0; plane < (layout_.planar ? layout_.samples : 1); ++plane)
            for (int y = area_.top; y < area_.bottom; ++y) {
                rows.read(y, plane, buffer_);
                unpack_row({0, 0, y, 1, plane}, 0);
            }
    }

    void read(const Block& block) {
        const std::int64_t first = std::max<std::int64_t>(area_.top - block.y, 0),
                           end = std::min(area_.bottom - block.y, block.rows);
        if (is_left_out(block.index)) {
            for (std::int64_t y = first; y < end; ++y) fill_row(block, y);
            return;
        }
        const std::size_t wanted = block_bytes(as_size(block.rows));
        const std::uint64_t theirs =
            layout_.tiled ? TIFFTileSize64(file_.get())
                          : TIFFVStripSize64(file_.get(), static_cast<std::uint32_t>(block.rows));
        if (theirs != wanted)
            throw file_.broken(
                cat("the TIFF's block ", block.index, " has ", theirs, " bytes, expected ", wanted));
        buffer_.resize(wanted);
        const auto size = static_cast<tmsize_t>(wanted);
        const tmsize_t got = layout_.tiled
                                 ? TIFFReadEncodedTile(file_.get(), block.index, buffer_.data(), size)
                                 : TIFFReadEncodedStrip(file_.get(), block.index, buffer_.data(), size);
        if (got != size) throw file_.broken(cat("the TIFF is broken or truncated in block ", block.index));
        for (std::int64_t y = first; y < end; ++y)
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

    // The columns of the block, from its left, that the area has.
    std::int64_t first_column(const Block& block) const {
        return std::max<std::int64_t>(area_.left - block.x, 0);
    }
    std::int64_t columns(const Block& block) const {
        return std::min(area_.right - block.x, layout_.block_width) - first_column(block);
    }

    float* place(const Block& block, std::int64_t row) {
        const std::int64_t x = block.x + first_column(block) - area_.left, y = block.y + row - area_.top;
        return out_.data() + as_size((y * area_.width() + x) * layout_.samples + block.sample);
    }

    void fill_row(const Block& block, std::int64_t row) {
        float* out = place(block, row);
        for (std::int64_t x = 0; x < columns(block); ++x, out += layout_.samples)
            std::fill_n(out, samples_of_block(), *fill_);
    }

    // Samples of few bits begin inside of a byte: such rows are unpacked from their first.
    void unpack_row(const Block& block, std::int64_t row) {
        std::span<const std::uint8_t> bytes(buffer_.data() + as_size(row) * row_bytes(), row_bytes());
        const std::int64_t skipped = first_column(block) * samples_of_block(),
                           count = columns(block) * samples_of_block();
        const std::size_t step = layout_.planar ? as_size(layout_.samples) : 1;
        if (skipped * layout_.bits % 8 == 0) {
            bytes = bytes.subspan(as_size(skipped * layout_.bits / 8));
            unpack_samples(bytes, as_size(count), layout_.kind, layout_.bits, place(block, row), step);
            return;
        }
        row_.resize(as_size(skipped + count));
        unpack_samples(bytes, row_.size(), layout_.kind, layout_.bits, row_.data(), 1);
        float* out = place(block, row);
        for (std::int64_t i = skipped; i < skipped + count; ++i, out += step) *out = row_[as_size(i)];
    }

    void unpack_chroma_row(const Block& block, std::int64_t row) {
        const int wide = layout_.chroma_x, high = layout_.chroma_y;
        const std::uint8_t* groups = buffer_.data() + as_size(row / high) * group_row_bytes();
        float* out = place(block, row);
        const std::int64_t first = first_column(block);
        for (std::int64_t x = first; x < first + columns(block); ++x, out += layout_.samples) {
            const std::uint8_t* group = groups + as_size(x / wide) * group_bytes();
            out[0] = group[as_size((row % high) * wide + x % wide)];
            out[1] = group[wide * high];
            out[2] = group[wide * high + 1];
        }
    }

    TiffFile& file_;
    const TiffLayout& layout_;
    const PixelRect area_;
    std::optional<float> fill_;
    std::vector<float>& out_;
    std::vector<std::uint8_t> buffer_;
    std::vector<float> row_;
};

// The blocks are where the file has bytes, so that no memory is taken for pixels of a file without.
void check_blocks(const TiffFile& file, const TiffLayout& layout, const PixelRect& area, bool may_leave_out) {
    // Old-style JPEG is one stream, whatever the strips are.
    if (file.tag<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_OJPEG) return;
    for_blocks(layout, area, [&](const Block& block) {
        int no_place = 0, no_length = 0;
        const std::uint64_t at = TIFFGetStrileOffsetWithErr(file.get(), block.index, &no_place),
                            bytes = TIFFGetStrileByteCountWithErr(file.get(), block.index, &no_length),
                            size = file.size();
        if (no_place || no_length)
            throw file.broken(
                cat("the TIFF is broken or truncated: no place is given for block ", block.index));
        if (at == 0 && bytes == 0 && may_leave_out) return;
        if (bytes == 0 || at >= size || bytes > size - at)
            throw file.broken(cat("the TIFF is broken or truncated: block ", block.index, " has ", bytes,
                                  " bytes at ", at, " in a file of ", size));
    });
}

}  // namespace

void check_block_count(const TiffFile& file, const TiffLayout& layout) {
    const std::int64_t planes = layout.planar ? layout.samples : 1,
                       blocks = planes * layout.blocks_across() * layout.blocks_down();
    const std::uint32_t count = layout.tiled ? TIFFNumberOfTiles(file.get()) : TIFFNumberOfStrips(file.get());
    if (count != blocks)
        throw file.broken(cat("the TIFF has ", count, " strips or tiles, expected ", blocks));
}

std::vector<float> read_samples(TiffFile& file, const TiffLayout& layout, const PixelRect& area,
                                std::optional<float> fill, TiffRows* rows) {
    check_blocks(file, layout, area, fill.has_value());
    std::vector<float> out =
        parallel_vector<float>(as_size(area.width()) * as_size(area.height()) * as_size(layout.samples));
    BlockReader reader(file, layout, area, fill, out);
    if (rows) {
        reader.read_rows(*rows);
        return out;
    }
    file.forget_messages();
    for_blocks(layout, area, [&](const Block& block) { reader.read(block); });
    // Some codecs only warn of pixels that are missing, and make them up.
    for (const std::string& warning : file.warnings())
        if (warning.find("remature") != std::string::npos)
            throw file.broken(cat("the TIFF is truncated: ", warning));
    return out;
}

}  // namespace imgmesh
