#include "formats/picture/codecs/color_wire.h"

#include <cstdint>

namespace imgmesh {

void put_color(WireWriter& out, const StatedColor& color) {
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
}

StatedColor take_color(WireReader& in) {
    StatedColor color;
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
    return color;
}

}  // namespace imgmesh
