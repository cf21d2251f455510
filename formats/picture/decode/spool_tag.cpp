#include "formats/picture/decode/spool_tag.h"

#include <algorithm>

#include "formats/picture/codecs/color_wire.h"

namespace imgmesh {
namespace {

constexpr std::string_view kWord = "imgmesh spool 1", kCopyWord = "imgmesh copy 1";

std::span<const std::uint8_t> stored_tag(const TiffFile& file) {
    std::uint32_t count = 0;
    const void* stored = nullptr;
    // The library does not know the tag, and gives the length of such.
    const TIFFField* const field = TIFFFindField(file.get(), kSpoolTag, TIFF_UNDEFINED);
    if (!field || TIFFFieldReadCount(field) != TIFF_VARIABLE2 ||
        TIFFGetField(file.get(), kSpoolTag, &count, &stored) != 1 || !stored)
        return {};
    return {static_cast<const std::uint8_t*>(stored), count};
}

}  // namespace

std::vector<std::uint8_t> spool_tag(const SpoolInfo& info) {
    WireWriter out;
    out.text(std::string(kWord));
    put_color(out, info.color);
    out.number(std::uint8_t{info.inks_upside_down});
    return out.result();
}

std::optional<SpoolInfo> spool_info(const TiffFile& file) {
    try {
        WireReader in(stored_tag(file));
        if (in.text() != kWord) return {};
        SpoolInfo info;
        info.color = take_color(in);
        info.inks_upside_down = in.number<std::uint8_t>() != 0;
        return info;
    } catch (const std::runtime_error&) {  // it ends too early: of another program
    }
    return {};
}

std::vector<std::uint8_t> copy_tag() {
    WireWriter out;
    out.text(std::string(kCopyWord));
    return out.result();
}

bool is_copy(const TiffFile& file) {
    return std::ranges::equal(stored_tag(file), copy_tag());
}

void set_spool_tag(TIFF* tiff, const std::vector<std::uint8_t>& tag) {
    TIFFFieldInfo field = {kSpoolTag,    -3, -3, TIFF_UNDEFINED,
                           FIELD_CUSTOM, 1,  1,  const_cast<char*>("ImgmeshSpool")};
    TIFFMergeFieldInfo(tiff, &field, 1);
    TIFFSetField(tiff, kSpoolTag, static_cast<std::uint32_t>(tag.size()), tag.data());
}

}  // namespace imgmesh
