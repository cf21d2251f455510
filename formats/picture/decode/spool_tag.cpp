#include "formats/picture/decode/spool_tag.h"

#include "formats/picture/codecs/wire.h"

namespace imgmesh {
namespace {

constexpr std::string_view kWord = "imgmesh spool 1";

SpoolInfo read_info(WireReader& in) {
    SpoolInfo info;
    StatedColor& color = info.color;
    const bool coded = in.number<std::uint8_t>() != 0;
    CodePoints codes;
    codes.primaries = in.number<int>();
    codes.transfer = in.number<int>();
    if (coded) color.code_points = codes;
    color.icc = in.bytes();
    color.name = in.text();
    const bool has_primaries = in.number<std::uint8_t>() != 0;
    Chromaticities xy{};
    for (double& number : xy) number = in.number<double>();
    if (has_primaries) color.chromaticities = xy;
    color.gamma = in.number<float>();
    color.inks = in.number<std::uint8_t>() != 0;
    info.inks_upside_down = in.number<std::uint8_t>() != 0;
    return info;
}

}  // namespace

std::vector<std::uint8_t> spool_tag(const SpoolInfo& info) {
    const StatedColor& color = info.color;
    WireWriter out;
    out.text(std::string(kWord));
    out.number(std::uint8_t{color.code_points.has_value()});
    const CodePoints codes = color.code_points.value_or(CodePoints{});
    out.number(codes.primaries);
    out.number(codes.transfer);
    out.bytes(color.icc);
    out.text(color.name);
    out.number(std::uint8_t{color.chromaticities.has_value()});
    for (const double number : color.chromaticities.value_or(Chromaticities{})) out.number(number);
    out.number(color.gamma);
    out.number(std::uint8_t{color.inks});
    out.number(std::uint8_t{info.inks_upside_down});
    return out.result();
}

std::optional<SpoolInfo> spool_info(const TiffFile& file) {
    std::uint32_t count = 0;
    const void* stored = nullptr;
    // The library does not know the tag, and gives the length of such.
    const TIFFField* const field = TIFFFindField(file.get(), kSpoolTag, TIFF_UNDEFINED);
    if (!field || TIFFFieldReadCount(field) != TIFF_VARIABLE2 ||
        TIFFGetField(file.get(), kSpoolTag, &count, &stored) != 1 || !stored)
        return {};
    try {
        WireReader in({static_cast<const std::uint8_t*>(stored), count});
        if (in.text() == kWord) return read_info(in);
    } catch (const std::runtime_error&) {  // it ends too early: of another program
    }
    return {};
}

}  // namespace imgmesh
