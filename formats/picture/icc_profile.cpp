#include "formats/picture/icc_profile.h"

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "libcore/image/color.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr std::size_t kHeaderSize = 128;

// Red, green and blue in XYZ, adapted from D65 to the profiles' white D50 by the Bradford matrix (columns of
// Lindbloom's tables); together they make D50.
struct Primaries {
    ColorSpace space;
    double xyz[3][3];
};
constexpr Primaries kPrimaries[] = {
    {ColorSpace::kSrgb,
     {{0.43607, 0.22250, 0.01393}, {0.38506, 0.71688, 0.09710}, {0.14308, 0.06062, 0.71417}}},
    {ColorSpace::kAdobeRgb,
     {{0.60974, 0.31111, 0.01947}, {0.20528, 0.62567, 0.06087}, {0.14919, 0.06322, 0.74457}}},
    {ColorSpace::kDisplayP3,
     {{0.51512, 0.24120, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.15710, 0.06657, 0.78407}}}};
// Profiles round differently, and old ones adapt by other matrices; neighbours are 0.07 apart.
constexpr double kPrimaryTolerance = 0.005;

// Spaces with sRGB's primaries tell themselves apart by their curve; in the middle it is 0.214 for sRGB,
// 0.218 for 2.2, 0.260 for Rec.709 and 0.5 for linear light.
constexpr ColorSpace kSrgbPrimaries[] = {ColorSpace::kSrgb, ColorSpace::kGamma22, ColorSpace::kRec709,
                                         ColorSpace::kLinear};
constexpr double kCurveTolerance = 0.0015;

std::uint32_t number(Bytes b, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    if (at > b.size() || count > b.size() - at) return 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | b[at + i];
    return value;
}
double fixed(Bytes b, std::size_t at) {  // s15Fixed16Number
    return static_cast<std::int32_t>(number(b, at, 4)) / 65536.0;
}
constexpr std::uint32_t tag_name(const char (&text)[5]) {
    std::uint32_t name = 0;
    for (int i = 0; i < 4; ++i) name = name << 8 | static_cast<std::uint8_t>(text[i]);
    return name;
}

// The element of that tag, empty where there is none.
Bytes find_tag(Bytes profile, std::uint32_t name) {
    const std::uint32_t count = number(profile, kHeaderSize, 4);
    for (std::size_t i = 0, at = kHeaderSize + 4; i < count && at + 12 <= profile.size(); ++i, at += 12) {
        if (number(profile, at, 4) != name) continue;
        const std::size_t offset = number(profile, at + 4, 4), size = number(profile, at + 8, 4);
        if (offset > profile.size() || size > profile.size() - offset) return {};
        return profile.subspan(offset, size);
    }
    return {};
}

// A tone curve's value at 0.5.
std::optional<double> curve_middle(Bytes curve) {
    if (number(curve, 0, 4) == tag_name("curv")) {
        const std::size_t count = number(curve, 8, 4);
        if (count == 0) return 0.5;
        if (count == 1) return std::pow(0.5, number(curve, 12, 2) / 256.0);
        if (curve.size() < 12 || count > (curve.size() - 12) / 2) return std::nullopt;
        const std::size_t low = (count - 1) / 2, high = count / 2;
        return (number(curve, 12 + 2 * low, 2) + number(curve, 12 + 2 * high, 2)) / (2 * 65535.0);
    }
    if (number(curve, 0, 4) == tag_name("para")) {
        // 0.5 lies above the linear branch of every known curve: (a x + b)^g.
        const double g = fixed(curve, 12);
        if (number(curve, 8, 2) == 0) return std::pow(0.5, g);
        return std::pow(0.5 * fixed(curve, 16) + fixed(curve, 20), g);
    }
    return std::nullopt;
}

double decode_middle(ColorSpace space) {
    return linear_from_encoded(space, Vec3f::Constant(0.5f))[0];
}

// ---- Writing
void put(std::vector<std::uint8_t>& out, std::uint32_t value, int count) {
    for (int i = count - 1; i >= 0; --i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}
void put_fixed(std::vector<std::uint8_t>& out, double value) {
    put(out, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * 65536))), 4);
}

std::vector<std::uint8_t> xyz_element(double x, double y, double z) {
    std::vector<std::uint8_t> out;
    put(out, tag_name("XYZ "), 4);
    put(out, 0, 4);
    for (const double value : {x, y, z}) put_fixed(out, value);
    return out;
}

std::vector<std::uint8_t> text_element(std::string_view text) {  // one English record, UTF-16
    std::vector<std::uint8_t> out;
    put(out, tag_name("mluc"), 4);
    put(out, 0, 4);
    put(out, 1, 4);
    put(out, 12, 4);
    put(out, 0x656E5553, 4);  // enUS
    put(out, static_cast<std::uint32_t>(2 * text.size()), 4);
    put(out, 28, 4);
    for (const char c : text) put(out, static_cast<std::uint8_t>(c), 2);
    return out;
}

std::vector<std::uint8_t> curve_element(ColorSpace space) {
    std::vector<double> parameters;  // g, or g a b c d: (a x + b)^g for x >= d, else c x
    switch (space) {
        case ColorSpace::kSrgb:
        case ColorSpace::kDisplayP3:
            parameters = {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
            break;
        case ColorSpace::kRec709:
            parameters = {1 / 0.45, 1 / 1.099, 0.099 / 1.099, 1 / 4.5, 0.081};
            break;
        case ColorSpace::kLinear:
            parameters = {1};
            break;
        case ColorSpace::kGamma22:
            parameters = {2.2};
            break;
        case ColorSpace::kAdobeRgb:
            parameters = {563.0 / 256};
            break;
    }
    std::vector<std::uint8_t> out;
    put(out, tag_name("para"), 4);
    put(out, 0, 4);
    put(out, parameters.size() == 1 ? 0 : 3, 2);
    put(out, 0, 2);
    for (const double value : parameters) put_fixed(out, value);
    return out;
}

const Primaries& primaries_of(ColorSpace space) {
    for (const Primaries& p : kPrimaries)
        if (p.space == space) return p;
    return kPrimaries[0];  // all the others have sRGB's
}

}  // namespace

std::optional<ColorSpace> color_space_from_icc(Bytes profile) {
    if (number(profile, 16, 4) != tag_name("RGB ")) return std::nullopt;
    const Bytes red = find_tag(profile, tag_name("rXYZ")), green = find_tag(profile, tag_name("gXYZ"));
    const auto middle = curve_middle(find_tag(profile, tag_name("gTRC")));
    if (red.size() < 20 || green.size() < 20 || !middle) return std::nullopt;
    const auto near = [](Bytes element, const double(&xyz)[3]) {
        for (std::size_t i = 0; i < 3; ++i)
            if (std::abs(fixed(element, 8 + 4 * i) - xyz[i]) > kPrimaryTolerance) return false;
        return true;
    };
    const auto same_curve = [&](ColorSpace space) {
        return std::abs(*middle - decode_middle(space)) <= kCurveTolerance;
    };
    for (const Primaries& p : kPrimaries) {
        if (!near(red, p.xyz[0]) || !near(green, p.xyz[1])) continue;
        if (p.space == ColorSpace::kSrgb) {
            for (const ColorSpace space : kSrgbPrimaries)
                if (same_curve(space)) return space;
        } else if (same_curve(p.space)) {
            return p.space;
        }
    }
    return std::nullopt;
}

std::vector<std::uint8_t> icc_from_color_space(ColorSpace space) {
    const auto& xyz = primaries_of(space).xyz;
    const auto curve = curve_element(space);
    const std::pair<std::uint32_t, std::vector<std::uint8_t>> elements[] = {
        {tag_name("desc"), text_element(color_space_name(space))},
        {tag_name("cprt"), text_element("No copyright, use freely")},
        {tag_name("wtpt"), xyz_element(0.9642, 1, 0.8249)},
        {tag_name("rXYZ"), xyz_element(xyz[0][0], xyz[0][1], xyz[0][2])},
        {tag_name("gXYZ"), xyz_element(xyz[1][0], xyz[1][1], xyz[1][2])},
        {tag_name("bXYZ"), xyz_element(xyz[2][0], xyz[2][1], xyz[2][2])},
        {tag_name("rTRC"), curve},
        {tag_name("gTRC"), curve},
        {tag_name("bTRC"), curve}};

    std::vector<std::uint8_t> table, body;
    put(table, static_cast<std::uint32_t>(std::size(elements)), 4);
    const std::size_t start = kHeaderSize + 4 + 12 * std::size(elements);
    for (const auto& [name, element] : elements) {
        put(table, name, 4);
        put(table, static_cast<std::uint32_t>(start + body.size()), 4);
        put(table, static_cast<std::uint32_t>(element.size()), 4);
        body.insert(body.end(), element.begin(), element.end());
        while (body.size() % 4) body.push_back(0);
    }

    std::vector<std::uint8_t> out;
    put(out, static_cast<std::uint32_t>(start + body.size()), 4);
    put(out, 0, 4);
    put(out, 0x04200000, 4);  // version 4.2
    for (const auto name : {tag_name("mntr"), tag_name("RGB "), tag_name("XYZ ")}) put(out, name, 4);
    // A fixed date, so that the same image gives the same file.
    for (const std::uint32_t part : {2000u, 1u, 1u, 0u, 0u, 0u}) put(out, part, 2);
    put(out, tag_name("acsp"), 4);
    out.resize(68);  // platform, flags, device, attributes, intent: all zero
    for (const double value : {0.9642, 1.0, 0.8249}) put_fixed(out, value);
    out.resize(kHeaderSize);
    out.insert(out.end(), table.begin(), table.end());
    out.insert(out.end(), body.begin(), body.end());
    return out;
}

}  // namespace imgmesh
