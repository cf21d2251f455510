// TGA by imgmesh itself: OpenImageIO 2.4 takes the fourth byte for alpha whatever the attribute bits say, and
// reads grey with alpha wrongly (docs/decisions/0025-own-readers-of-small-formats.md). Source: Truevision TGA
// File Format Specification, version 2.0.
#include <algorithm>
#include <optional>

#include "formats/files/byte_reader.h"
#include "formats/picture/decode/palette_image.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/decode/tga_signature.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kHeader = 18;
constexpr int kPalette = 1, kColor = 2, kGrey = 3, kRuns = 8;  // image types; kRuns is added to the others

struct Header {
    std::uint32_t id_bytes, palette_type, type, palette_first, palette_size, palette_bits, width, height,
        bits, descriptor;

    int kind() const { return static_cast<int>(type & ~std::uint32_t{kRuns}); }
    bool has_runs() const { return (type & kRuns) != 0; }
    std::uint32_t attribute_bits() const { return descriptor & 15; }
    bool from_right() const { return (descriptor & 0x10) != 0; }
    bool from_top() const { return (descriptor & 0x20) != 0; }
    std::size_t pixel_bytes() const { return (bits + 7) / 8; }
};

enum class Alpha { kNone, kStraight, kAssociated };

struct Reader {
    const PictureFile& file;
    Header header = {};
    std::optional<std::uint32_t> attributes = {};  // the type of version 2
    DecodedPicture out = {};

    Error broken(const std::string& what) const { return {ErrorKind::kBadFile, cat(file.path, ": ", what)}; }
    Error unsupported(const std::string& what) const {
        return {ErrorKind::kUnsupported, cat(file.path, ": a TGA ", what, " is not supported")};
    }

    void read_header() {
        ByteReader in(file.bytes, ByteOrder::kLittle);
        if (in.left() < kHeader) throw broken("the TGA is truncated: it has no whole header");
        const std::uint32_t id_bytes = in.number(1), palette_type = in.number(1), type = in.number(1);
        const std::uint32_t first = in.number(2), size = in.number(2), palette_bits = in.number(1);
        in.take(4);  // where the image lies on a screen
        const std::uint32_t width = in.number(2), height = in.number(2), bits = in.number(1);
        header = {id_bytes, palette_type, type, first, size, palette_bits, width, height, bits, in.number(1)};
    }

    void check_header() const {
        if (header.type == 32 || header.type == 33) throw unsupported("of Huffman codes");
        const int kind = header.kind();
        if (header.palette_type > 1 || header.type > (kGrey | kRuns) || kind < kPalette || kind > kGrey)
            throw broken(cat("not a TGA: image type ", header.type, ", palette type ", header.palette_type));
        const std::uint32_t palette = header.palette_bits;
        if (header.palette_type == 1 && palette != 15 && palette != 16 && palette != 24 && palette != 32)
            throw broken(cat("the TGA's palette has ", palette, " bits a colour, expected 15, 16, 24 or 32"));
        if (kind == kPalette && (header.palette_type == 0 || header.palette_size == 0))
            throw broken("the TGA has no palette");
        const bool fits =
            kind == kColor ? header.bits == 15 || header.bits == 16 || header.bits == 24 || header.bits == 32
                           : header.bits == 8 || header.bits == 16;
        if (!fits)
            throw broken(cat("the TGA has ", header.bits, " bits a pixel, expected ",
                             kind == kColor ? "15, 16, 24 or 32" : "8 or 16"));
        if (header.descriptor & 0xC0) throw unsupported("of interleaved rows");
        check_size(file.path, header.width, header.height, kind == kGrey ? 1 : 3, file.options.limits);
    }

    void read_extension() {
        const ByteReader in(file.bytes, ByteOrder::kLittle);
        const std::size_t at = has_tga_footer(file.bytes) ? in.number_at(file.bytes.size() - 26, 4) : 0;
        if (at < kHeader || in.number_at(at, 2) < 495 || at + 495 > file.bytes.size()) return;
        attributes = in.number_at(at + 494, 1);
        // A gamma of 1 says nothing: most writers put it there.
        const std::uint32_t numerator = in.number_at(at + 478, 2), denominator = in.number_at(at + 480, 2);
        const float gamma =
            denominator == 0 ? 0 : static_cast<float>(numerator) / static_cast<float>(denominator);
        if (gamma > 1.01f && gamma <= 10) out.color.gamma = gamma;
    }

    // What the extension says counts, else the number of attribute bits. `bits` of a pixel or palette colour.
    Alpha alpha(std::uint32_t bits) {
        constexpr std::uint32_t kUseful = 3, kMultiplied = 4;
        if (bits != 32 && bits != 16) return Alpha::kNone;
        if (!attributes) return header.attribute_bits() > 0 ? Alpha::kStraight : Alpha::kNone;
        if (*attributes == kUseful) return Alpha::kStraight;
        if (*attributes == kMultiplied) return Alpha::kAssociated;
        if (header.attribute_bits() > 0)
            out.warnings.push_back("it says that its alpha is of no use, so it was left out");
        return Alpha::kNone;
    }

    // The bytes of all pixels as they are stored, without runs.
    std::vector<std::uint8_t> unpacked(ByteReader in) const {
        const std::size_t size = header.pixel_bytes();
        const std::size_t pixels = std::size_t{header.width} * header.height;
        // A run of 128 pixels takes at least a byte and a pixel.
        const std::size_t needed = header.has_runs() ? (pixels + 127) / 128 * (1 + size) : pixels * size;
        if (needed > in.left())
            throw broken(cat("the TGA is truncated: its pixels take at least ", needed, " bytes, ", in.left(),
                             " are left"));
        std::vector<std::uint8_t> all;
        all.reserve(pixels * size);
        if (!header.has_runs()) {
            const Bytes bytes = in.take(pixels * size);
            all.assign(bytes.begin(), bytes.end());
        }
        while (all.size() < pixels * size) {
            try {
                const std::uint32_t packet = in.number(1);
                // What a last packet has beyond the image is dropped.
                const std::size_t count =
                    std::min<std::size_t>((packet & 127) + 1, (pixels * size - all.size()) / size);
                const Bytes piece = in.take(packet & 128 ? size : count * size);
                for (std::size_t i = 0; i < (packet & 128 ? count : 1); ++i)
                    all.insert(all.end(), piece.begin(), piece.end());
            } catch (const EndOfBytes&) {
                throw broken(cat("the TGA is truncated: its runs end after ", all.size() / size, " of ",
                                 pixels, " pixels"));
            }
        }
        return all;
    }

    // Where pixel i of the file is in the image.
    std::size_t place(std::size_t i) const {
        const std::size_t width = header.width, x = i % width, y = i / width;
        return (header.from_top() ? y : header.height - 1 - y) * width +
               (header.from_right() ? width - 1 - x : x);
    }

    std::vector<PaletteColor> read_palette(ByteReader& in, bool alpha) const;
    void read_colors(Bytes stored, Alpha alpha);
    void read_grey(Bytes stored, Alpha alpha);
    void read_indices(Bytes stored, std::span<const PaletteColor> palette, Alpha alpha);
    void read();
};

// 15 and 16 bits are ARRRRRGGGGGBBBBB, 24 and 32 B, G, R and A.
std::array<float, 4> color_of(std::uint32_t pixel, std::uint32_t bits) {
    const auto part = [&](int shift, std::uint32_t most) {
        return static_cast<float>(pixel >> shift & most) / static_cast<float>(most);
    };
    if (bits <= 16) return {part(10, 31), part(5, 31), part(0, 31), part(15, 1)};
    return {part(16, 255), part(8, 255), part(0, 255), part(24, 255)};
}

std::vector<PaletteColor> Reader::read_palette(ByteReader& in, bool alpha) const {
    const std::size_t size = (header.palette_bits + 7) / 8;
    std::vector<PaletteColor> palette;
    if (header.palette_type == 0) return palette;
    if (size * header.palette_size > in.left()) throw broken("the TGA is truncated in its palette");
    for (std::uint32_t i = 0; i < header.palette_size; ++i) {
        const auto color = color_of(in.number(static_cast<int>(size)), header.palette_bits);
        PaletteColor& codes = palette.emplace_back();
        for (std::size_t c = 0; c < 4; ++c) codes[c] = static_cast<std::uint8_t>(color[c] * 255 + 0.5f);
        if (!alpha) codes[3] = 255;
    }
    return palette;
}

void Reader::read_colors(Bytes stored, Alpha alpha) {
    out.image = make_image(static_cast<int>(header.width), static_cast<int>(header.height),
                           alpha == Alpha::kNone ? 3 : 4);
    const auto channels = static_cast<std::size_t>(out.image.channels);
    ByteReader in(stored, ByteOrder::kLittle);
    for (std::size_t i = 0; in.left() > 0; ++i) {
        const auto color = color_of(in.number(static_cast<int>(header.pixel_bytes())), header.bits);
        std::copy_n(color.begin(), channels,
                    out.image.data.begin() + static_cast<std::ptrdiff_t>(place(i) * channels));
    }
}

void Reader::read_grey(Bytes stored, Alpha alpha) {
    out.image = make_image(static_cast<int>(header.width), static_cast<int>(header.height),
                           alpha == Alpha::kNone ? 1 : 2);
    const auto channels = static_cast<std::size_t>(out.image.channels);
    const std::size_t size = header.pixel_bytes();
    for (std::size_t i = 0; i * size < stored.size(); ++i)
        for (std::size_t c = 0; c < channels; ++c)
            out.image.data[place(i) * channels + c] = static_cast<float>(stored[i * size + c]) / 255;
}

void Reader::read_indices(Bytes stored, std::span<const PaletteColor> palette, Alpha alpha) {
    std::vector<std::uint16_t> indices(std::size_t{header.width} * header.height);
    ByteReader in(stored, ByteOrder::kLittle);
    // An index below the first wraps around, beyond the palette.
    for (std::size_t i = 0; i < indices.size(); ++i)
        indices[place(i)] = static_cast<std::uint16_t>(in.number(static_cast<int>(header.pixel_bytes())) -
                                                       header.palette_first);
    out.image = image_from_palette(static_cast<int>(header.width), static_cast<int>(header.height), indices,
                                   palette, alpha != Alpha::kNone, out.warnings);
}

void Reader::read() {
    read_header();
    check_header();
    read_extension();
    const int kind = header.kind();
    const Alpha found = alpha(kind == kPalette ? header.palette_bits : header.bits);
    check_size(file.path, header.width, header.height,
               (kind == kGrey ? 1 : 3) + (found == Alpha::kNone ? 0 : 1), file.options.limits);
    ByteReader in(file.bytes, ByteOrder::kLittle);
    in.take(kHeader);
    if (header.id_bytes > in.left()) throw broken("the TGA is truncated: it has no pixels");
    in.take(header.id_bytes);
    const std::vector<PaletteColor> palette = read_palette(in, found != Alpha::kNone);
    const std::vector<std::uint8_t> stored = unpacked(in);
    if (kind == kPalette) read_indices(stored, palette, found);
    if (kind == kColor) read_colors(stored, found);
    if (kind == kGrey) read_grey(stored, found);
    out.associated_alpha = found == Alpha::kAssociated;
    drop_empty_alpha(out.image, out.warnings);
}

}  // namespace

DecodedPicture decode_tga(const PictureFile& file) {
    Reader reader{file};
    reader.read();
    return std::move(reader.out);
}

}  // namespace imgmesh
