// Sources: PNG, third edition, section 11.3.3; ImageMagick's "Raw profile type" (coders/png.c); XMP part 3
// for its keyword.
#include "formats/picture/decode/png_text.h"

#include <libdeflate.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <new>
#include <optional>

#include "formats/files/byte_reader.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr std::size_t kMaxText = std::size_t{1} << 20;
constexpr int kMaxUnpacked = 16;  // texts a file: enough for any writer, few enough for any attacker

// The name of a profile, its size, and its bytes in hexadecimal, each on lines of their own.
std::vector<std::uint8_t> raw_profile(std::string_view text) {
    std::vector<std::uint8_t> out;
    constexpr std::string_view kSpace = " \t\r\n";
    for (int word = 0; word < 2; ++word) {  // steps over the name and the size
        text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
        text.remove_prefix(std::min(text.find_first_of(kSpace), text.size()));
    }
    std::optional<unsigned> high;
    for (const char& c : text) {
        unsigned digit = 0;
        if (kSpace.find(c) != std::string_view::npos) continue;
        if (std::from_chars(&c, &c + 1, digit, 16).ptr == &c) break;
        if (high) {
            out.push_back(static_cast<std::uint8_t>(*high << 4 | digit));
            high.reset();
        } else {
            high = digit;
        }
    }
    return out;
}

}  // namespace

std::vector<std::uint8_t> inflated(Bytes zlib, std::size_t most) {
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> unpacker(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    if (!unpacker) throw std::bad_alloc();
    std::vector<std::uint8_t> out;
    std::size_t size = 0;
    libdeflate_result result = LIBDEFLATE_INSUFFICIENT_SPACE;
    for (std::size_t room = std::size_t{1} << 16; result == LIBDEFLATE_INSUFFICIENT_SPACE && room <= most;
         room *= 16) {
        out.resize(room);
        result = libdeflate_zlib_decompress(unpacker.get(), zlib.data(), zlib.size(), out.data(), out.size(),
                                            &size);
    }
    out.resize(result == LIBDEFLATE_SUCCESS ? size : 0);
    return out;
}

void PngText::add(std::string_view chunk, Bytes content) {
    const std::string_view all = text_of(content);
    const std::size_t end = all.find('\0');
    if (end == std::string_view::npos) return;
    const std::string_view keyword = all.substr(0, end);
    const bool exif = keyword == "Raw profile type exif" || keyword == "Raw profile type APP1";
    const bool raw_xmp = keyword == "Raw profile type xmp";
    const bool xmp = keyword == "XML:com.adobe.xmp" || raw_xmp;
    if (!exif && !xmp) return;
    std::size_t start = end + 1;
    bool packed = false;
    if (chunk == "zTXt") {
        packed = true;
        ++start;  // the method, which is always deflate
    } else if (chunk == "iTXt") {
        packed = start < content.size() && content[start] == 1;
        start += 2;
        for (int text = 0; text < 2; ++text)  // the language, and the keyword in it
            start = std::min(all.find('\0', std::min(start, all.size())), all.size() - 1) + 1;
    }
    if (start >= content.size() || (packed && ++unpacked_ > kMaxUnpacked)) return;
    const std::vector<std::uint8_t> unpacked =
        packed ? inflated(content.subspan(start), kMaxText) : std::vector<std::uint8_t>();
    const std::string_view text = packed ? text_of(unpacked) : all.substr(start);
    if (!exif && !raw_xmp) {
        if (xmp_ == 0) xmp_ = xmp_orientation(text);
        return;
    }
    const std::vector<std::uint8_t> profile = raw_profile(text.substr(0, 2 * kMaxText));
    // A profile of type APP1 may be either.
    if (exif_ == 0 && exif) exif_ = exif_facts(profile).orientation;
    if (xmp_ == 0) xmp_ = xmp_orientation(text_of(profile));
}

}  // namespace imgmesh
