// Source: TIFF 6.0 (Adobe, 1992), its supplements, and libtiff's tiff.h for the numbers that came later.
#include "formats/picture/decode/tiff_layout.h"

#include <algorithm>
#include <string_view>

#include "formats/files/byte_reader.h"
#include "formats/picture/decode/picture_probe.h"

namespace imgmesh {
namespace {

constexpr std::uint16_t kLinearRaw = 34892;  // of DNG
constexpr ttag_t kDngVersion = 50706;
constexpr int kMostPages = 65535;

struct Named {
    std::uint16_t number;
    std::string_view name;
};
constexpr Named kCompressions[] = {{COMPRESSION_CCITTRLE, "CCITT RLE"},
                                   {COMPRESSION_CCITTFAX3, "CCITT fax 3"},
                                   {COMPRESSION_CCITTFAX4, "CCITT fax 4"},
                                   {COMPRESSION_LZW, "LZW"},
                                   {COMPRESSION_OJPEG, "old-style JPEG"},
                                   {COMPRESSION_JPEG, "JPEG"},
                                   {COMPRESSION_T85, "JBIG T.85"},
                                   {COMPRESSION_T43, "JBIG T.43"},
                                   {COMPRESSION_NEXT, "NeXT"},
                                   {COMPRESSION_PACKBITS, "PackBits"},
                                   {COMPRESSION_THUNDERSCAN, "ThunderScan"},
                                   {COMPRESSION_PIXARFILM, "Pixar film"},
                                   {COMPRESSION_PIXARLOG, "Pixar log"},
                                   {COMPRESSION_DEFLATE, "deflate"},
                                   {COMPRESSION_ADOBE_DEFLATE, "deflate"},
                                   {COMPRESSION_DCS, "Kodak DCS"},
                                   {COMPRESSION_JBIG, "JBIG"},
                                   {COMPRESSION_SGILOG, "SGI LogLuv"},
                                   {COMPRESSION_SGILOG24, "SGI LogLuv 24"},
                                   {COMPRESSION_JP2000, "JPEG 2000"},
                                   {33003, "JPEG 2000"},
                                   {33005, "JPEG 2000"},
                                   {COMPRESSION_LERC, "LERC"},
                                   {COMPRESSION_LZMA, "LZMA"},
                                   {COMPRESSION_ZSTD, "Zstandard"},
                                   {COMPRESSION_WEBP, "WebP"},
                                   {COMPRESSION_JXL, "JPEG XL"},
                                   {34892, "lossy JPEG"}};
constexpr Named kPhotometrics[] = {{PHOTOMETRIC_CFA, "a camera's colour filter array"},
                                   {kLinearRaw, "a camera's linear raw values"},
                                   {PHOTOMETRIC_ITULAB, "ITU L*a*b*"},
                                   {51177, "a depth map of DNG"},
                                   {52527, "a semantic mask of DNG"}};

std::string named(std::uint16_t number, std::span<const Named> names) {
    for (const Named& n : names)
        if (n.number == number) return cat(n.name, " (", number, ")");
    return cat("number ", number);
}

// libtiff does not read SubfileType, which SubFileType has replaced.
bool is_old_thumbnail(const TiffFile& file) {
    const bool big = TIFFIsBigTIFF(file.get()) != 0;
    const std::uint64_t start = TIFFCurrentDirOffset(file.get());
    const bool big_endian = TIFFIsBigEndian(file.get()) != 0;
    constexpr std::size_t kMostTags = 65535, kTagBytes = 20, kCountBytes = 8;
    const std::vector<std::uint8_t> bytes = file.bytes_at(start, kCountBytes + kMostTags * kTagBytes);
    const ByteReader in(bytes, big_endian ? ByteOrder::kBig : ByteOrder::kLittle);
    const std::size_t count = big ? in.number_at(big_endian ? 4 : 0, 4) : in.number_at(0, 2);
    for (std::size_t i = 0; i < std::min(count, kMostTags); ++i) {
        const std::size_t entry = big ? 8 + 20 * i : 2 + 12 * i;
        if (in.number_at(entry, 2) == TIFFTAG_OSUBFILETYPE)
            return in.number_at(entry + (big ? 12 : 8), 2) == OFILETYPE_REDUCEDIMAGE;
    }
    return false;
}

bool is_full_size(const TiffFile& file) {
    const auto flags = file.tag<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0);
    return (flags & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0 && !is_old_thumbnail(file) &&
           file.tag<std::uint16_t>(TIFFTAG_PHOTOMETRIC, 0) != PHOTOMETRIC_MASK;
}

int expected_color_samples(std::uint16_t photometric) {
    switch (photometric) {
        case PHOTOMETRIC_RGB:
        case PHOTOMETRIC_YCBCR:
        case PHOTOMETRIC_CIELAB:
        case PHOTOMETRIC_ICCLAB:
        case PHOTOMETRIC_LOGLUV:
            return 3;
        case PHOTOMETRIC_SEPARATED:
            return 4;
        default:
            return 1;
    }
}

void check_kind(const TiffFile& file, TiffLayout& layout) {
    const auto format = file.defaulted_tag<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    switch (format) {
        case SAMPLEFORMAT_UINT:
        case SAMPLEFORMAT_VOID:
            layout.kind = TiffSamples::kUnsigned;
            break;
        case SAMPLEFORMAT_INT:
            layout.kind = TiffSamples::kSigned;
            break;
        case SAMPLEFORMAT_IEEEFP:
            layout.kind = TiffSamples::kFloat;
            break;
        default:
            throw file.unsupported(
                cat("TIFF with complex samples (format ", format, "), expected integers or floats"));
    }
    const int b = layout.bits;
    const bool fits = layout.kind == TiffSamples::kFloat ? b == 16 || b == 24 || b == 32 || b == 64
                                                         : (b >= 1 && b <= 32) || b == 64;
    if (!fits)
        throw file.unsupported(cat("TIFF with ", layout.kind == TiffSamples::kFloat ? "floats" : "integers",
                                   " of ", b, " bits is not supported"));
}

void check_photometric(const TiffFile& file, const TiffLayout& layout) {
    const auto refuse = [&](const std::string& what) -> Error {
        return file.unsupported(cat("TIFF colours as ", what, " are not supported"));
    };
    const bool integers = layout.kind != TiffSamples::kFloat;
    switch (layout.photometric) {
        case PHOTOMETRIC_MINISWHITE:
        case PHOTOMETRIC_MINISBLACK:
        case PHOTOMETRIC_RGB:
        case PHOTOMETRIC_MASK:
            break;
        case PHOTOMETRIC_PALETTE:
            if (!integers || layout.bits > 16)
                throw refuse(cat("a palette with indices of ", layout.bits, " bits"));
            break;
        case PHOTOMETRIC_SEPARATED: {
            const auto inks = file.defaulted_tag<std::uint16_t>(TIFFTAG_INKSET, INKSET_CMYK);
            const auto count = file.defaulted_tag<std::uint16_t>(TIFFTAG_NUMBEROFINKS, 4);
            if (inks != INKSET_CMYK || count != 4 || layout.samples < 4)
                throw refuse(cat(std::min<int>(count, layout.samples), " inks that are not CMYK"));
            break;
        }
        case PHOTOMETRIC_YCBCR:
            if (!integers || layout.bits > 16 || layout.samples < 3) throw refuse("YCbCr of this depth");
            break;
        case PHOTOMETRIC_CIELAB:
        case PHOTOMETRIC_ICCLAB:
            if (!integers || (layout.bits != 8 && layout.bits != 16) || layout.samples < 3)
                throw refuse(cat("L*a*b* of ", layout.bits, " bits"));
            break;
        case PHOTOMETRIC_LOGL:
        case PHOTOMETRIC_LOGLUV:
            break;
        default:
            throw refuse(named(layout.photometric, kPhotometrics));
    }
    if (layout.color_samples() < expected_color_samples(layout.photometric))
        throw file.broken(cat("TIFF with ", layout.samples, " samples a pixel, its colours need ",
                              expected_color_samples(layout.photometric)));
}

// JPEG's own colours are converted by its codec, the other codecs leave them to us.
void set_chroma(const TiffFile& file, TiffLayout& layout, std::uint16_t compression) {
    if (layout.photometric != PHOTOMETRIC_YCBCR) return;
    if (compression == COMPRESSION_JPEG && !layout.planar) {
        TIFFSetField(file.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
        layout.photometric = PHOTOMETRIC_RGB;
        return;
    }
    std::uint16_t x = 2, y = 2;
    TIFFGetFieldDefaulted(file.get(), TIFFTAG_YCBCRSUBSAMPLING, &x, &y);
    const auto possible = [](std::uint16_t n) { return n == 1 || n == 2 || n == 4; };
    if (!possible(x) || !possible(y)) throw file.broken(cat("TIFF with chroma of ", x, " x ", y, " pixels"));
    layout.chroma_x = x;
    layout.chroma_y = y;
    if ((x > 1 || y > 1) && (layout.planar || layout.bits != 8 || layout.samples != 3))
        throw file.unsupported(
            "TIFF with subsampled chroma in planes, of more than 8 bits or beside other "
            "channels is not supported");
}

void set_log_luv(const TiffFile& file, TiffLayout& layout, std::uint16_t compression) {
    if (layout.photometric != PHOTOMETRIC_LOGL && layout.photometric != PHOTOMETRIC_LOGLUV) return;
    if (compression != COMPRESSION_SGILOG && compression != COMPRESSION_SGILOG24)
        throw file.unsupported(cat("TIFF with LogLuv colours in compression ",
                                   named(compression, kCompressions), " is not supported"));
    if (!layout.extras.empty() || layout.planar)
        throw file.unsupported("TIFF with LogLuv colours and other channels or planes is not supported");
    TIFFSetField(file.get(), TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT);
    layout.kind = TiffSamples::kFloat;
    layout.bits = 32;
}

void set_blocks(const TiffFile& file, TiffLayout& layout, const ImageLimits& limits) {
    layout.tiled = TIFFIsTiled(file.get()) != 0;
    if (!layout.tiled) {
        layout.block_width = layout.width;
        layout.block_height = std::min<std::int64_t>(
            file.defaulted_tag<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, 0xFFFFFFFFu), layout.height);
        if (layout.block_height < 1) throw file.broken("TIFF with strips of no rows");
        return;
    }
    layout.block_width = file.tag<std::uint32_t>(TIFFTAG_TILEWIDTH, 0);
    layout.block_height = file.tag<std::uint32_t>(TIFFTAG_TILELENGTH, 0);
    check_block_size(file.path(), layout.block_width, layout.block_height, layout.samples, limits);
    // A small image may lie in one large tile, but not in one for whose sake memory runs out.
    constexpr std::int64_t kLargeTile = std::int64_t{1} << 22;
    if (layout.block_width * layout.block_height > std::max(kLargeTile, 4 * layout.width * layout.height))
        throw file.broken(cat("TIFF of ", layout.width, "x", layout.height, " pixels in tiles of ",
                              layout.block_width, "x", layout.block_height));
}

}  // namespace

bool choose_page(TiffFile& file) {
    if (is_full_size(file)) return false;
    for (int page = 1; page < kMostPages && TIFFReadDirectory(file.get()) == 1; ++page)
        if (is_full_size(file)) return false;
    if (TIFFSetDirectory(file.get(), 0) != 1) throw file.broken("cannot read the TIFF");
    return true;
}

TiffLayout tiff_layout(const TiffFile& file, const ImageLimits& limits, const ImageLimits& tile_limits) {
    TiffLayout layout;
    layout.width = file.tag<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
    layout.height = file.tag<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
    layout.samples = file.defaulted_tag<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
    layout.bits = file.defaulted_tag<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
    check_size(file.path(), layout.width, layout.height, layout.samples, limits);
    if (file.defaulted_tag<std::uint32_t>(TIFFTAG_IMAGEDEPTH, 1) > 1)
        throw file.unsupported("TIFF of volumes is not supported");
    std::uint16_t count = 0, *extras = nullptr;
    if (TIFFGetField(file.get(), TIFFTAG_EXTRASAMPLES, &count, &extras) == 1 && count <= layout.samples)
        layout.extras.assign(extras, extras + count);
    // A grey image is what a file without the tag most likely is.
    layout.photometric = file.tag<std::uint16_t>(
        TIFFTAG_PHOTOMETRIC, layout.samples >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    layout.planar =
        layout.samples > 1 &&
        file.defaulted_tag<std::uint16_t>(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) != PLANARCONFIG_CONTIG;
    const int color = expected_color_samples(layout.photometric);
    if (layout.color_samples() > color)  // the standard wants the tag, some writers leave it out
        layout.extras.insert(layout.extras.begin(), static_cast<std::size_t>(layout.color_samples() - color),
                             EXTRASAMPLE_UNSPECIFIED);

    const auto compression = file.defaulted_tag<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    const void* version = nullptr;
    if (layout.photometric == PHOTOMETRIC_CFA || layout.photometric == kLinearRaw ||
        TIFFGetField(file.get(), kDngVersion, &version) == 1)
        throw file.unsupported("camera raw files are not supported; develop it to TIFF, EXR or PNG");
    if (TIFFIsCODECConfigured(compression) == 0)
        throw file.unsupported(
            cat("TIFF in compression ", named(compression, kCompressions), " is not supported"));
    check_kind(file, layout);
    check_photometric(file, layout);
    set_chroma(file, layout, compression);
    set_log_luv(file, layout, compression);
    set_blocks(file, layout, tile_limits);
    return layout;
}

}  // namespace imgmesh
