// Sources: the formats' specifications.
#include "formats/files/image_signature.h"

#include <algorithm>

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;

struct Signature {
    std::string_view name;
    std::size_t offset;
    std::string_view bytes;
};

using namespace std::string_view_literals;
constexpr Signature kSignatures[] = {{"PNG", 0, "\x89PNG\r\n\x1a\n"sv},
                                     {"JPEG", 0, "\xFF\xD8\xFF"sv},
                                     {"TIFF", 0, "II*\0"sv},
                                     {"TIFF", 0, "MM\0*"sv},
                                     {"TIFF", 0, "II+\0"sv},
                                     {"TIFF", 0, "MM\0+"sv},
                                     {"EXR", 0, "\x76\x2f\x31\x01"sv},
                                     {"WebP", 8, "WEBPVP8"sv},
                                     {"GIF", 0, "GIF8"sv},
                                     {"BMP", 0, "BM"sv},
                                     {"BMP", 0, "BA"sv},
                                     {"HDR", 0, "#?"sv},
                                     {"JPEG 2000", 0, "\0\0\0\x0CjP  "sv},
                                     {"JPEG 2000", 0, "\xFF\x4F\xFF\x51"sv},
                                     {"HEIF", 4, "ftyphei"sv},
                                     {"HEIF", 4, "ftyphevc"sv},
                                     {"HEIF", 4, "ftypmif1"sv},
                                     {"HEIF", 4, "ftypavif"sv}};

bool has_at(Bytes bytes, std::size_t offset, std::string_view text) {
    return bytes.size() >= offset + text.size() &&
           std::equal(text.begin(), text.end(), bytes.begin() + std::ptrdiff_t(offset),
                      [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

}  // namespace

std::string_view image_signature(Bytes bytes) {
    for (const Signature& s : kSignatures)
        if (has_at(bytes, s.offset, s.bytes)) return s.name;
    return "";
}

bool has_coded_signature(Bytes bytes) {
    return has_at(bytes, 0, "\x9AIM"sv);
}

bool has_glb_signature(Bytes bytes) {
    return has_at(bytes, 0, "glTF");
}

}  // namespace imgmesh
