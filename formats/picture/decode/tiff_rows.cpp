#include "formats/picture/decode/tiff_rows.h"

#include <algorithm>
#include <array>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::array<std::uint16_t, 11> kStreams = {
    COMPRESSION_NONE,          COMPRESSION_CCITTRLE, COMPRESSION_CCITTFAX3, COMPRESSION_CCITTFAX4,
    COMPRESSION_LZW,           COMPRESSION_JPEG,     COMPRESSION_PACKBITS,  COMPRESSION_DEFLATE,
    COMPRESSION_ADOBE_DEFLATE, COMPRESSION_LZMA,     COMPRESSION_ZSTD};

std::uint32_t strip_count(const TiffLayout& layout) {
    return static_cast<std::uint32_t>(layout.blocks_down() * (layout.planar ? layout.samples : 1));
}

}  // namespace

bool has_rows(const TiffFile& file, const TiffLayout& layout) {
    const auto compression = file.tag<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    if (layout.tiled || layout.chroma_x > 1 || layout.chroma_y > 1 ||
        std::ranges::count(kStreams, compression) == 0)
        return false;
    for (std::uint32_t i = 0; i < strip_count(layout); ++i)
        if (TIFFGetStrileOffset(file.get(), i) == 0) return false;
    return held_strip(file, layout) <= kMostAtOnce;
}

std::uint64_t held_strip(const TiffFile& file, const TiffLayout& layout) {
    if (has_streams(file, layout)) return 0;
    std::uint64_t most = 0;
    for (std::uint32_t i = 0; i < strip_count(layout); ++i)
        most = std::max<std::uint64_t>(most, TIFFGetStrileByteCount(file.get(), i));
    return most;
}

TiffRows::TiffRows(TiffFile& file, const TiffLayout& layout)
    : file_(file),
      layout_(layout),
      row_bytes_(static_cast<std::size_t>(
          (layout.width * (layout.planar ? 1 : layout.samples) * layout.bits + 7) / 8)) {
    if (const std::uint64_t theirs = TIFFScanlineSize64(file.get()); theirs != row_bytes_)
        throw file.broken(cat("the TIFF's rows have ", theirs, " bytes, expected ", row_bytes_));
    if (has_streams(file, layout)) streams_.emplace(file, layout, row_bytes_);
    checked_.resize(strip_count(layout));
}

void TiffRows::read(std::int64_t y, int plane, std::span<std::uint8_t> row) {
    const std::int64_t index = plane * layout_.blocks_down() + strip(y);
    if (!has_plain_rows(file_) && !checked_[static_cast<std::size_t>(index)]) check(index, plane, row);
    read_unchecked(y, plane, row);
}

void TiffRows::check(std::int64_t index, int plane, std::span<std::uint8_t> row) {
    const std::int64_t first = index % layout_.blocks_down() * layout_.block_height,
                       end = std::min(first + layout_.block_height, layout_.height);
    for (std::int64_t y = first; y < end; ++y) read_unchecked(y, plane, row);
    if (streams_ && !streams_->ends_well())
        throw file_.broken(cat("the TIFF is broken or truncated at the end of strip ", index));
    checked_[static_cast<std::size_t>(index)] = 1;
}

void TiffRows::read_unchecked(std::int64_t y, int plane, std::span<std::uint8_t> row) {
    if (streams_)
        streams_->read(y, plane, row);
    else
        read_by_libtiff(y, plane, row);
}

void TiffRows::read_by_libtiff(std::int64_t y, int plane, std::span<std::uint8_t> row) {
    const std::int64_t wanted = plane * layout_.blocks_down() + strip(y);
    // Few codecs can step over rows.
    std::int64_t next = strip(y) * layout_.block_height;
    if (TIFFCurrentStrip(file_.get()) == wanted) {
        const std::int64_t here = TIFFCurrentRow(file_.get());
        if (here <= y) next = std::max(next, here);
    }
    file_.forget_messages();
    for (; next <= y; ++next) {
        const int done = TIFFReadScanline(file_.get(), row.data(), static_cast<std::uint32_t>(next),
                                          static_cast<std::uint16_t>(plane));
        // Some codecs only warn of pixels that are missing, and make them up.
        const bool cut = std::ranges::any_of(file_.warnings(), [](const std::string& warning) {
            return warning.find("remature") != std::string::npos;
        });
        if (done != 1 || cut)
            throw file_.broken(cat("the TIFF is broken or truncated in row ", next, " of strip ", wanted));
    }
}

}  // namespace imgmesh
