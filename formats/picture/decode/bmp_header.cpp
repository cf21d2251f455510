// Sources: BITMAPFILEHEADER, BITMAPCOREHEADER, BITMAPINFOHEADER, BITMAPV4HEADER and BITMAPV5HEADER of the
// Windows documentation; BITMAPFILEHEADER2 and BITMAPINFOHEADER2 of OS/2's.
#include "formats/picture/decode/bmp_header.h"

#include <algorithm>
#include <bit>

#include "formats/files/byte_reader.h"
#include "formats/picture/decode/bmp_color.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kFileHeader = 14;
constexpr std::uint32_t kNone = 0, kRuns8 = 1, kRuns4 = 2, kMasks = 3, kJpeg = 4, kPng = 5,
                        kMasksWithAlpha = 6;
constexpr std::uint32_t kCore = 12, kInfo = 40, kInfo2 = 52, kInfo3 = 56, kInfo4 = 108, kInfo5 = 124;

// Reads the header at `start`. Fields past its end are 0, as the fields that a shorter header leaves out.
struct Reader {
    const std::string& path;
    Bytes bytes;
    std::size_t start;   // of the header
    std::uint32_t size;  // of the header
    BmpHeader out = {};
    std::uint32_t compression = kNone;

    Error broken(const std::string& what) const { return {ErrorKind::kBadFile, cat(path, ": ", what)}; }
    Error unsupported(const std::string& what) const {
        return {ErrorKind::kUnsupported, cat(path, ": a BMP ", what, " is not supported")};
    }
    std::uint32_t number(std::size_t at, int count) const {
        if (at + static_cast<std::size_t>(count) > size) return 0;
        return ByteReader(bytes, ByteOrder::kLittle).number_at(start + at, count);
    }
    bool is_os2() const {
        return size != kInfo && size != kInfo2 && size != kInfo3 && size != kInfo4 && size != kInfo5;
    }

    void read_size() {
        if (size == kCore) {
            out.width = number(4, 2);
            out.height = number(6, 2);
            out.bits = static_cast<int>(number(10, 2));
            return;
        }
        out.width = static_cast<std::int32_t>(number(4, 4));
        out.height = static_cast<std::int32_t>(number(8, 4));
        out.top_down = out.height < 0;
        if (out.top_down) out.height = -out.height;
        out.bits = static_cast<int>(number(14, 2));
        compression = number(16, 4);
    }

    void check_coding() {
        if (compression == kMasks && (is_os2() || out.bits == 1)) throw unsupported("of OS/2's Huffman code");
        if (compression > kJpeg && is_os2()) throw unsupported(cat("of OS/2's compression ", compression));
        if (compression == kJpeg || compression == kPng) {
            out.coding = BmpCoding::kFile;
            return;
        }
        if (compression > kMasksWithAlpha) throw unsupported(cat("of compression ", compression));
        if (out.bits == 64) throw unsupported("of 64 bits a pixel");
        const int known[] = {1, 2, 4, 8, 16, 24, 32};
        if (!std::ranges::count(known, out.bits))
            throw broken(cat("the BMP has ", out.bits, " bits a pixel, expected 1, 2, 4, 8, 16, 24 or 32"));
        const bool masks = compression == kMasks || compression == kMasksWithAlpha;
        if ((compression == kRuns8 && out.bits != 8) || (compression == kRuns4 && out.bits != 4) ||
            (masks && out.bits < 16))
            throw broken(cat("the BMP has ", out.bits, " bits a pixel with compression ", compression,
                             ", which is for ",
                             masks                   ? "16 to 32"
                             : compression == kRuns8 ? "8"
                                                     : "4"));
        if (compression == kRuns8) out.coding = BmpCoding::kRuns8;
        if (compression == kRuns4) out.coding = BmpCoding::kRuns4;
    }

    // OS/2 has another meaning for the number that says JPEG.
    void check_file_inside() const {
        const std::string_view inside = text_of(bytes.subspan(out.pixels));
        if (compression == kJpeg && !inside.starts_with("\xFF\xD8\xFF"))
            throw unsupported("of OS/2's runs of 24 bits");
        if (compression == kPng && !inside.starts_with("\x89PNG\r\n"))
            throw broken("the BMP says that it holds a PNG, and does not");
    }

    // Masks that stand between a header without room for them and the palette.
    std::size_t masks_behind() const {
        if (size != kInfo || (compression != kMasks && compression != kMasksWithAlpha)) return 0;
        return compression == kMasks ? 12 : 16;
    }

    void read_masks() {
        const bool stated = compression == kMasks || compression == kMasksWithAlpha;
        const bool has_alpha = size >= kInfo3 || compression == kMasksWithAlpha;
        const ByteReader in(bytes, ByteOrder::kLittle);
        for (std::size_t c = 0; stated && c < (has_alpha ? 4 : 3); ++c)
            out.masks[c] = in.number_at(start + kInfo + 4 * c, 4);
        if (!stated) {
            out.masks = {0xFF0000, 0xFF00, 0xFF, 0};
            if (out.bits == 16) out.masks = {0x7C00, 0x3E0, 0x1F, 0};
            // Programs that copy images with alpha state its mask alone.
            if (out.bits == 32 && number(kInfo + 12, 4) == 0xFF000000) out.masks[3] = 0xFF000000;
        }
        check_masks();
    }

    void check_masks() {
        const std::uint32_t depth = out.bits == 32 ? 0xFFFFFFFF : (std::uint32_t{1} << out.bits) - 1;
        out.masks[3] &= depth;  // some writers state an alpha of 32 bits for 16
        const char* const names[] = {"red", "green", "blue", "alpha"};
        std::uint32_t used = 0;
        for (std::size_t c = 0; c < 4; ++c) {
            const std::uint32_t mask = out.masks[c];
            if (mask == 0) continue;
            if (mask & ~depth)
                throw broken(
                    cat("the BMP's mask of ", names[c], " is beyond the ", out.bits, " bits of a pixel"));
            if (mask & used) throw broken(cat("the BMP's mask of ", names[c], " overlaps another"));
            if (!std::has_single_bit((mask >> std::countr_zero(mask)) + std::uint64_t{1}))
                throw broken(cat("the BMP's mask of ", names[c], " has gaps"));
            used |= mask;
        }
        if ((used & ~out.masks[3]) == 0) throw broken("the BMP's masks of red, green and blue are all 0");
    }

    // The palette ends where the pixels begin, whatever the header says about its size.
    void read_palette_and_place() {
        const std::size_t begin = start + size + masks_behind(), entry = size == kCore ? 3 : 4;
        const std::uint32_t stated = number(32, 4);
        const bool indices = out.bits >= 1 && out.bits <= 8;
        const std::size_t most = indices ? std::size_t{1} << out.bits : 0;
        std::size_t colors = stated == 0 ? most : std::min<std::size_t>(stated, indices ? most : 256);
        out.pixels = ByteReader(bytes, ByteOrder::kLittle).number_at(start - kFileHeader + 10, 4);
        if (out.pixels < begin + (indices ? entry : 0)) {
            if (out.pixels != 0)
                out.warnings.push_back(
                    "its pixels would begin inside its header; they were read from after it");
            out.pixels = begin + colors * entry;
        }
        if (out.pixels > bytes.size())
            throw broken(
                cat("the BMP's pixels would begin at byte ", out.pixels, ", and it ends at ", bytes.size()));
        if (!indices) return;
        colors = std::min(colors, (out.pixels - begin) / entry);
        for (std::size_t i = 0; i < colors; ++i) {
            const Bytes bgr = bytes.subspan(begin + i * entry, 3);
            out.palette.push_back({bgr[2], bgr[1], bgr[0], 255});
        }
    }
};

}  // namespace

BmpHeader read_bmp_header(const std::string& path, Bytes bytes) {
    const ByteReader in(bytes, ByteOrder::kLittle);
    // An array of bitmaps has a header of its own before the first one's.
    const bool array = in.has_at(0, "BA");
    const std::size_t start = (array ? kFileHeader : 0) + kFileHeader;
    if (array && !in.has_at(kFileHeader, "BM"))
        throw Error(ErrorKind::kUnsupported,
                    cat(path, ": an OS/2 file of icons or pointers is not supported"));
    Reader r{path, bytes, start, in.number_at(start, 4)};
    const bool known =
        r.size == kCore || (r.size >= 16 && r.size <= 64) || r.size == kInfo4 || r.size == kInfo5;
    if (!known || r.size > bytes.size() - std::min(start, bytes.size()))
        throw r.broken(cat("the BMP has a header of ", r.size,
                           " bytes, expected 12, 16 to 64, 108 or 124 that are in the file"));
    r.read_size();
    r.check_coding();
    r.read_palette_and_place();
    if (r.out.coding == BmpCoding::kFile)
        r.check_file_inside();
    else if (r.out.bits > 8)
        r.read_masks();
    if (!r.is_os2() && r.size >= kInfo4) state_bmp_color(bytes.subspan(start), r.out.color, r.out.warnings);
    return std::move(r.out);
}

}  // namespace imgmesh
