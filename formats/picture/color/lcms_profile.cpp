// Source of the tolerances: comparisons of the profiles that cameras and editors write.
#include "formats/picture/color/lcms_profile.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "formats/files/one_line.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

constexpr ColorSpace kSpaces[] = {ColorSpace::kSrgb,    ColorSpace::kLinear,   ColorSpace::kRec709,
                                  ColorSpace::kGamma22, ColorSpace::kAdobeRgb, ColorSpace::kDisplayP3};

// Little CMS copies the bytes. JPEG holds no longer profile, and matrix profiles have a few kilobytes.
constexpr std::size_t kMaxProfileBytes = std::size_t{16} << 20;

// Profiles round differently, and old ones adapt white by other matrices; the primaries of our spaces are
// 0.07 apart in XYZ.
constexpr double kColorTolerance = 0.005;
// Of linear light. Tables are rounded; sRGB and power 2.2 are 0.008 apart at 0.75, Rec.709 0.09 from both.
constexpr double kCurveTolerance = 0.0015;

LcmsCurve curve_of(ColorSpace space) {
    switch (space) {
        case ColorSpace::kSrgb:
        case ColorSpace::kDisplayP3:
            return broken_curve({2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045});
        case ColorSpace::kRec709:
            return broken_curve({1 / 0.45, 1 / 1.099, 0.099 / 1.099, 1 / 4.5, 0.081});
        case ColorSpace::kLinear:
            return power_curve(1);
        case ColorSpace::kGamma22:
            return power_curve(2.2);
        case ColorSpace::kAdobeRgb:
            return power_curve(563.0 / 256);
    }
    return nullptr;
}

// The effect of a profile on colours.
constexpr int kSteps = 16;
constexpr std::array<std::array<double, 3>, 7> kColors = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {0.75, 0.5, 0.25}, {0.25, 0.75, 0.5}, {0.5, 0.25, 0.75}}};
using Steps = std::array<float, kSteps>;
struct Behaviour {
    std::array<Steps, 3> curves;
    std::array<cmsCIEXYZ, kColors.size()> colors;
};

// Nothing for a tag that is missing or broken.
std::optional<Steps> steps_of(const LcmsProfile& profile, cmsTagSignature tag) {
    const auto* curve = static_cast<const cmsToneCurve*>(cmsReadTag(profile.get(), tag));
    if (!curve) return std::nullopt;
    Steps out;
    for (std::size_t i = 0; i < kSteps; ++i)
        out[i] = cmsEvalToneCurveFloat(curve, static_cast<float>(i + 1) / kSteps);
    return out;
}

// Returns nothing for a profile without a matrix, or one that Little CMS cannot use.
std::optional<Behaviour> behaviour_of(const LcmsProfile& profile) {
    if (cmsGetColorSpace(profile.get()) != cmsSigRgbData || !cmsIsMatrixShaper(profile.get()))
        return std::nullopt;
    Behaviour out;
    constexpr std::array kCurves = {cmsSigRedTRCTag, cmsSigGreenTRCTag, cmsSigBlueTRCTag};
    for (std::size_t c = 0; c < kCurves.size(); ++c) {
        const std::optional<Steps> steps = steps_of(profile, kCurves[c]);
        if (!steps) return std::nullopt;
        out.curves[c] = *steps;
    }
    const LcmsProfile xyz = made(LcmsProfile(cmsCreateXYZProfile()));
    const LcmsTransform transform(cmsCreateTransform(profile.get(), TYPE_RGB_DBL, xyz.get(), TYPE_XYZ_DBL,
                                                     INTENT_RELATIVE_COLORIMETRIC,
                                                     cmsFLAGS_NOOPTIMIZE | cmsFLAGS_NOCACHE));
    if (!transform) return std::nullopt;
    cmsDoTransform(transform.get(), kColors.data(), out.colors.data(), kColors.size());
    return out;
}

// NaNs are never alike.
bool alike(const Steps& a, const Steps& b) {
    for (std::size_t i = 0; i < kSteps; ++i)
        if (!(std::abs(a[i] - b[i]) <= kCurveTolerance)) return false;
    return true;
}
bool alike(const Behaviour& a, const Behaviour& b) {
    for (std::size_t c = 0; c < 3; ++c)
        if (!alike(a.curves[c], b.curves[c])) return false;
    for (std::size_t i = 0; i < kColors.size(); ++i) {
        const cmsCIEXYZ &p = a.colors[i], &q = b.colors[i];
        if (!(std::abs(p.X - q.X) <= kColorTolerance && std::abs(p.Y - q.Y) <= kColorTolerance &&
              std::abs(p.Z - q.Z) <= kColorTolerance))
            return false;
    }
    return true;
}

const std::array<Behaviour, std::size(kSpaces)>& our_behaviours() {
    static const auto kOurs = [] {
        std::array<Behaviour, std::size(kSpaces)> all;
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] = behaviour_of(profile_from_color_space(kSpaces[i])).value();
        return all;
    }();
    return kOurs;
}

cmsCIExyY chromaticity(const Eigen::Vector3d& xyz) {
    return {xyz[0] / xyz.sum(), xyz[1] / xyz.sum(), 1};
}

}  // namespace

LcmsCurve power_curve(double g) {
    return made(LcmsCurve(cmsBuildParametricToneCurve(nullptr, 1, &g)));
}
LcmsCurve broken_curve(std::array<double, 5> gabcd) {
    return made(LcmsCurve(cmsBuildParametricToneCurve(nullptr, 4, gabcd.data())));
}

LcmsProfile profile_from_primaries(const Chromaticities& xy, const cmsToneCurve& curve) {
    const cmsCIExyY white{xy[0], xy[1], 1};
    const cmsCIExyYTRIPLE primaries{{xy[2], xy[3], 1}, {xy[4], xy[5], 1}, {xy[6], xy[7], 1}};
    cmsToneCurve* const same = const_cast<cmsToneCurve*>(&curve);  // which it copies
    cmsToneCurve* const curves[] = {same, same, same};
    return LcmsProfile(cmsCreateRGBProfile(&white, &primaries, curves));
}

LcmsProfile profile_from_color_space(ColorSpace space) {
    const Eigen::Matrix3d xyz = rgb_from_xyz(space).inverse();
    const cmsCIExyY white = chromaticity(xyz.rowwise().sum()), red = chromaticity(xyz.col(0)),
                    green = chromaticity(xyz.col(1)), blue = chromaticity(xyz.col(2));
    const LcmsCurve curve = curve_of(space);
    return made(
        profile_from_primaries({white.x, white.y, red.x, red.y, green.x, green.y, blue.x, blue.y}, *curve));
}

LcmsProfile profile_from_icc(std::span<const std::uint8_t> icc) {
    if (icc.size() > kMaxProfileBytes) return nullptr;
    return LcmsProfile(cmsOpenProfileFromMem(icc.data(), static_cast<cmsUInt32Number>(icc.size())));
}

std::string profile_name(const LcmsProfile& profile) {
    std::array<char, 81> text = {};
    cmsGetProfileInfoASCII(profile.get(), cmsInfoDescription, "en", "US", text.data(), text.size());
    text.back() = 0;
    const std::string name = printable(text.data());
    return name.empty() ? "without a name" : "\"" + name + "\"";
}

std::optional<ColorSpace> color_space_of(const LcmsProfile& profile) {
    // Little CMS would prefer tables, which are made for one rendering intent each.
    for (const cmsTagSignature table : {cmsSigAToB0Tag, cmsSigAToB1Tag, cmsSigAToB2Tag, cmsSigDToB0Tag,
                                        cmsSigDToB1Tag, cmsSigDToB2Tag, cmsSigDToB3Tag})
        cmsWriteTag(profile.get(), table, nullptr);  // removes it from the copy in memory
    if (cmsGetPCS(profile.get()) != cmsSigXYZData) return std::nullopt;
    const auto& ours = our_behaviours();
    if (cmsGetColorSpace(profile.get()) == cmsSigGrayData) {
        const std::optional<Steps> steps = steps_of(profile, cmsSigGrayTRCTag);
        for (std::size_t i = 0; steps && i < ours.size(); ++i)
            if (alike(*steps, ours[i].curves[0])) return kSpaces[i];
        return std::nullopt;
    }
    const std::optional<Behaviour> found = behaviour_of(profile);
    for (std::size_t i = 0; found && i < ours.size(); ++i)
        if (alike(*found, ours[i])) return kSpaces[i];
    return std::nullopt;
}

}  // namespace imgmesh
