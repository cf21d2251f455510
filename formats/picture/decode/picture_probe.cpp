// Sources: the formats' specifications - GIF89a (18), HEIF (ISO/IEC 23008-12, `ispe`).
#include "formats/picture/decode/picture_probe.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include "formats/files/byte_reader.h"
#include "formats/files/extension.h"
#include "formats/files/image_signature.h"
#include "formats/picture/decode/jpeg2000_claim.h"
#include "formats/picture/decode/other_formats.h"
#include "formats/picture/decode/tga_signature.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;

Error broken(const std::string& path, const std::string& what) {
    return Error(ErrorKind::kBadFile, cat(path, ": ", what));
}

// Numbers past the end are 0, which no check below accepts as a size.
ByteReader big_endian(Bytes b) {
    return {b, ByteOrder::kBig};
}
ByteReader little_endian(Bytes b) {
    return {b, ByteOrder::kLittle};
}

// Returns the position of `text` in the first megabyte, from `from` on: headers of HEIF are at the start.
std::optional<std::size_t> find(Bytes b, std::size_t from, std::string_view text) {
    constexpr std::size_t kWindow = std::size_t{1} << 20;
    const std::size_t at = text_of(b.first(std::min(b.size(), kWindow))).find(text, from);
    return at == std::string_view::npos ? std::nullopt : std::optional(at);
}

// A file holds several sizes (tiles, thumbnails); the image's is the largest.
void claim_heif(Bytes b, PictureClaim& claim) {
    const ByteReader in = big_endian(b);
    for (auto at = find(b, 0, "ispe"); at; at = find(b, *at + 4, "ispe")) {
        claim.width = std::max<std::int64_t>(claim.width, in.number_at(*at + 8, 4));
        claim.height = std::max<std::int64_t>(claim.height, in.number_at(*at + 12, 4));
    }
}

// The formats that have a signature at their begin.
constexpr std::pair<std::string_view, PictureFormat> kFormats[] = {
    {"PNG", PictureFormat::kPng},  {"JPEG", PictureFormat::kJpeg}, {"TIFF", PictureFormat::kTiff},
    {"EXR", PictureFormat::kExr},  {"WebP", PictureFormat::kWebp}, {"GIF", PictureFormat::kGif},
    {"BMP", PictureFormat::kBmp},  {"HDR", PictureFormat::kHdr},   {"JPEG 2000", PictureFormat::kJpeg2000},
    {"HEIF", PictureFormat::kHeif}};

// Camera raw files have TIFF's signature, and their first TIFF image is a thumbnail.
constexpr std::string_view kRawExtensions[] = {".3fr", ".arw", ".cr2", ".dcr", ".dng", ".erf",
                                               ".iiq", ".kdc", ".mef", ".mos", ".nef", ".nrw",
                                               ".pef", ".rw2", ".sr2", ".srw"};

constexpr std::string_view kTgaExtensions[] = {".tga", ".tpic", ".vda", ".icb", ".vst"};

PictureFormat recognise(const std::string& path, Bytes b) {
    const std::string extension = lower_extension(path);
    if (b.empty()) throw broken(path, "is empty, expected an image");
    const std::string_view signature = image_signature(b);
    for (const auto& [name, format] : kFormats) {
        if (signature != name) continue;
        if (format == PictureFormat::kTiff && std::ranges::count(kRawExtensions, extension))
            throw Error(ErrorKind::kUnsupported,
                        cat(path, ": camera raw files are not supported; develop it to TIFF, EXR or PNG"));
        return format;
    }
    const bool letter_p = b.size() > 2 && b[0] == 'P' && (std::isspace(b[2]) || b[2] == '#');
    const bool pam = letter_p && b[1] == '7' && b[2] != ' ';  // a space follows in thumbnails of XV
    if (pam || (letter_p && ((b[1] >= '1' && b[1] <= '6') || b[1] == 'F' || b[1] == 'f')))
        return PictureFormat::kPnm;
    if (has_tga_footer(b)) return PictureFormat::kTga;
    if (const std::string other = name_other_format(b, extension); !other.empty())
        throw Error(ErrorKind::kUnsupported, cat(path, ": ", other));
    if (std::ranges::count(kTgaExtensions, extension)) return PictureFormat::kTga;
    throw broken(path,
                 "not an image that imgmesh reads (PNG, JPEG, TIFF, EXR, WebP, GIF, BMP, PNM, TGA, HDR, "
                 "JPEG 2000, HEIF)");
}

}  // namespace

PictureClaim probe_picture(const std::string& path, Bytes b) {
    PictureClaim claim{recognise(path, b)};
    const ByteReader little = little_endian(b);
    switch (claim.format) {
        case PictureFormat::kGif:
            claim.width = little.number_at(6, 2);
            claim.height = little.number_at(8, 2);
            break;
        case PictureFormat::kJpeg2000:
            claim_jpeg2000(path, b, claim);
            break;
        case PictureFormat::kHeif:
            claim_heif(b, claim);
            break;
        case PictureFormat::kJpeg:
        case PictureFormat::kPng:
        case PictureFormat::kTiff:
        case PictureFormat::kExr:
        case PictureFormat::kWebp:
        case PictureFormat::kHdr:
        case PictureFormat::kBmp:
        case PictureFormat::kPnm:
        case PictureFormat::kTga:
            break;
    }
    return claim;
}

}  // namespace imgmesh
