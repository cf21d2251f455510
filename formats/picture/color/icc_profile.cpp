// ICC profiles through Little CMS. Source of the header's layout: ICC.1:2010 (4.3), section 7.2.
#include "formats/picture/color/icc_profile.h"

#include <lcms2.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <string>

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

template <typename T, void (*close)(T*)>
struct Closer {
    void operator()(T* object) const { close(object); }
};
void close_profile(void* profile) {
    cmsCloseProfile(profile);
}
using Profile = std::unique_ptr<void, Closer<void, close_profile>>;
using Transform = std::unique_ptr<void, Closer<void, cmsDeleteTransform>>;
using Curve = std::unique_ptr<cmsToneCurve, Closer<cmsToneCurve, cmsFreeToneCurve>>;
using Text = std::unique_ptr<cmsMLU, Closer<cmsMLU, cmsMLUfree>>;

// For our own calls, which fail only if memory is short.
template <typename Pointer>
Pointer made(Pointer object) {
    if (!object) throw std::bad_alloc();
    return object;
}

Curve curve_of(ColorSpace space) {
    // Power g, or (a x + b)^g for x >= d and c x below: types 1 and 4 of Little CMS.
    const auto power = [](double g) { return Curve(cmsBuildParametricToneCurve(nullptr, 1, &g)); };
    const auto broken = [](std::array<double, 5> gabcd) {
        return Curve(cmsBuildParametricToneCurve(nullptr, 4, gabcd.data()));
    };
    switch (space) {
        case ColorSpace::kSrgb:
        case ColorSpace::kDisplayP3:
            return broken({2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045});
        case ColorSpace::kRec709:
            return broken({1 / 0.45, 1 / 1.099, 0.099 / 1.099, 1 / 4.5, 0.081});
        case ColorSpace::kLinear:
            return power(1);
        case ColorSpace::kGamma22:
            return power(2.2);
        case ColorSpace::kAdobeRgb:
            return power(563.0 / 256);
    }
    return nullptr;
}

cmsCIExyY chromaticity(const Eigen::Vector3d& xyz) {
    return {xyz[0] / xyz.sum(), xyz[1] / xyz.sum(), 1};
}

Profile profile_of(ColorSpace space) {
    const Eigen::Matrix3d xyz = rgb_from_xyz(space).inverse();
    const cmsCIExyY white = chromaticity(xyz.rowwise().sum());
    const cmsCIExyYTRIPLE primaries = {chromaticity(xyz.col(0)), chromaticity(xyz.col(1)),
                                       chromaticity(xyz.col(2))};
    const Curve curve = made(curve_of(space));
    cmsToneCurve* const curves[] = {curve.get(), curve.get(), curve.get()};
    return made(Profile(cmsCreateRGBProfile(&white, &primaries, curves)));
}

// The effect of a profile on colours.
constexpr int kSteps = 16;
constexpr std::array<std::array<double, 3>, 7> kColors = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {0.75, 0.5, 0.25}, {0.25, 0.75, 0.5}, {0.5, 0.25, 0.75}}};
struct Behaviour {
    std::array<std::array<float, kSteps>, 3> curves;
    std::array<cmsCIEXYZ, kColors.size()> colors;
};

// Returns nothing for a profile without a matrix, or one that Little CMS cannot use.
std::optional<Behaviour> behaviour_of(const Profile& profile) {
    // Little CMS would prefer tables, which are made for one rendering intent each.
    for (const cmsTagSignature table : {cmsSigAToB0Tag, cmsSigAToB1Tag, cmsSigAToB2Tag, cmsSigDToB0Tag,
                                        cmsSigDToB1Tag, cmsSigDToB2Tag, cmsSigDToB3Tag})
        cmsWriteTag(profile.get(), table, nullptr);  // removes it from the copy in memory
    if (cmsGetColorSpace(profile.get()) != cmsSigRgbData || cmsGetPCS(profile.get()) != cmsSigXYZData ||
        !cmsIsMatrixShaper(profile.get()))
        return std::nullopt;
    Behaviour out;
    constexpr std::array kCurves = {cmsSigRedTRCTag, cmsSigGreenTRCTag, cmsSigBlueTRCTag};
    for (std::size_t c = 0; c < kCurves.size(); ++c) {
        const auto* curve = static_cast<const cmsToneCurve*>(cmsReadTag(profile.get(), kCurves[c]));
        if (!curve) return std::nullopt;
        for (std::size_t i = 0; i < kSteps; ++i)
            out.curves[c][i] = cmsEvalToneCurveFloat(curve, static_cast<float>(i + 1) / kSteps);
    }
    const Profile xyz = made(Profile(cmsCreateXYZProfile()));
    const Transform transform(cmsCreateTransform(profile.get(), TYPE_RGB_DBL, xyz.get(), TYPE_XYZ_DBL,
                                                 INTENT_RELATIVE_COLORIMETRIC,
                                                 cmsFLAGS_NOOPTIMIZE | cmsFLAGS_NOCACHE));
    if (!transform) return std::nullopt;
    cmsDoTransform(transform.get(), kColors.data(), out.colors.data(), kColors.size());
    return out;
}

// NaNs are never alike.
bool alike(const Behaviour& a, const Behaviour& b) {
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < kSteps; ++i)
            if (!(std::abs(a.curves[c][i] - b.curves[c][i]) <= kCurveTolerance)) return false;
    for (std::size_t i = 0; i < kColors.size(); ++i) {
        const cmsCIEXYZ &p = a.colors[i], &q = b.colors[i];
        if (!(std::abs(p.X - q.X) <= kColorTolerance && std::abs(p.Y - q.Y) <= kColorTolerance &&
              std::abs(p.Z - q.Z) <= kColorTolerance))
            return false;
    }
    return true;
}

std::array<Behaviour, std::size(kSpaces)> our_behaviours() {
    std::array<Behaviour, std::size(kSpaces)> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = behaviour_of(profile_of(kSpaces[i])).value();
    return all;
}

}  // namespace

std::optional<ColorSpace> color_space_from_icc(std::span<const std::uint8_t> bytes) {
    if (bytes.size() > kMaxProfileBytes) return std::nullopt;
    const Profile profile(cmsOpenProfileFromMem(bytes.data(), static_cast<cmsUInt32Number>(bytes.size())));
    const std::optional<Behaviour> found = profile ? behaviour_of(profile) : std::nullopt;
    if (!found) return std::nullopt;
    static const auto kOurs = our_behaviours();
    for (std::size_t i = 0; i < kOurs.size(); ++i)
        if (alike(*found, kOurs[i])) return kSpaces[i];
    return std::nullopt;
}

std::vector<std::uint8_t> icc_from_color_space(ColorSpace space) {
    const Profile profile = profile_of(space);
    cmsSetProfileVersion(profile.get(), 4.3);
    const Text name = made(Text(cmsMLUalloc(nullptr, 1)));
    cmsUInt32Number size = 0;
    if (!cmsMLUsetASCII(name.get(), "en", "US", std::string(color_space_name(space)).c_str()) ||
        !cmsWriteTag(profile.get(), cmsSigProfileDescriptionTag, name.get()) ||
        !cmsSaveProfileToMem(profile.get(), nullptr, &size))
        throw std::bad_alloc();
    std::vector<std::uint8_t> bytes(size);
    if (!cmsSaveProfileToMem(profile.get(), bytes.data(), &size)) throw std::bad_alloc();
    // Little CMS writes the time. The same image must give the same file, so it is noon, 1 January 2000.
    constexpr std::size_t kDateOffset = 24;
    constexpr std::array<std::uint8_t, 12> kDate = {2000 >> 8, 2000 & 0xFF, 0, 1, 0, 1, 0, 12, 0, 0, 0, 0};
    std::ranges::copy(kDate, bytes.begin() + kDateOffset);
    return bytes;
}

}  // namespace imgmesh
