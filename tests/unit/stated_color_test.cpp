// What images become whose colours are stated by profiles, primaries and code points of every kind. The
// profiles are made here by Little CMS; the expected numbers are by hand or from the literature.
#include <doctest/doctest.h>
#include <lcms2.h>

#include <cmath>
#include <vector>

#include "formats/picture/color/icc_profile.h"
#include "formats/picture/color/stated_color.h"
#include "libcore/image/color.h"
#include "tests/support/icc_bytes.h"

using namespace imgmesh;
using test::saved;
using Bytes = std::vector<std::uint8_t>;
using Texts = std::vector<std::string>;

namespace {

constexpr cmsCIExyY kD65 = {0.3127, 0.3290, 1};
constexpr cmsCIExyY kD50 = {0.3457, 0.3585, 1};
constexpr cmsCIExyYTRIPLE kRec2020 = {{0.708, 0.292, 1}, {0.170, 0.797, 1}, {0.131, 0.046, 1}};
constexpr cmsCIExyYTRIPLE kProPhoto = {{0.7347, 0.2653, 1}, {0.1596, 0.8404, 1}, {0.0366, 0.0001, 1}};

Bytes matrix_profile(const cmsCIExyY& white, const cmsCIExyYTRIPLE& primaries, double gamma,
                     double version = 4.3) {
    cmsToneCurve* const curve = cmsBuildGamma(nullptr, gamma);
    cmsToneCurve* const curves[] = {curve, curve, curve};
    const Bytes bytes = saved(cmsCreateRGBProfile(&white, &primaries, curves), version);
    cmsFreeToneCurve(curve);
    return bytes;
}

Bytes grey_profile(double gamma) {
    cmsToneCurve* const curve = cmsBuildGamma(nullptr, gamma);
    const Bytes bytes = saved(cmsCreateGrayProfile(&kD65, curve));
    cmsFreeToneCurve(curve);
    return bytes;
}

// A profile of tables alone, from `model` to L*a*b*. `lab` gives the colour of a corner of the cube of inks
// or lights; between corners it is interpolated.
Bytes table_profile(cmsColorSpaceSignature model, cmsProfileClassSignature kind, double version,
                    cmsCIELab (*lab)(const bool* corner)) {
    cmsHPROFILE profile = cmsCreateProfilePlaceholder(nullptr);
    cmsSetProfileVersion(profile, version);
    cmsSetDeviceClass(profile, kind);
    cmsSetColorSpace(profile, model);
    cmsSetPCS(profile, cmsSigLabData);
    const cmsUInt32Number channels = cmsChannelsOf(model);
    std::vector<cmsUInt16Number> nodes;
    for (unsigned i = 0; i < 1u << channels; ++i) {
        bool corner[4] = {};
        for (unsigned c = 0; c < channels; ++c) corner[c] = i >> (channels - 1 - c) & 1;
        const cmsCIELab color = lab(corner);
        cmsUInt16Number code[3];
        if (version < 4)
            cmsFloat2LabEncodedV2(code, &color);
        else
            cmsFloat2LabEncoded(code, &color);
        nodes.insert(nodes.end(), code, code + 3);
    }
    cmsPipeline* const table = cmsPipelineAlloc(nullptr, channels, 3);
    for (cmsStage* stage : {cmsStageAllocToneCurves(nullptr, channels, nullptr),
                            cmsStageAllocCLut16bit(nullptr, 2, channels, 3, nodes.data()),
                            cmsStageAllocToneCurves(nullptr, 3, nullptr)})
        REQUIRE(cmsPipelineInsertStage(table, cmsAT_END, stage));
    REQUIRE(cmsWriteTag(profile, cmsSigAToB0Tag, table));
    cmsPipelineFree(table);
    const cmsCIEXYZ white = *cmsD50_XYZ();
    REQUIRE(cmsWriteTag(profile, cmsSigMediaWhitePointTag, &white));
    return saved(profile, version);
}

Image pixel(std::vector<float> samples, SampleType type = SampleType::kUint8) {
    Image image = make_image(1, 1, static_cast<int>(samples.size()));
    image.data = std::move(samples);
    image.sample_type = type;
    return image;
}

Image settled(StatedColor stated, Image image, Texts* warnings = nullptr,
              std::optional<ColorSpace> asked = {}) {
    Texts texts;
    settle_color(stated, asked, image, texts);
    if (warnings)
        *warnings = texts;
    else
        CHECK(texts.empty());
    return image;
}

void check_linear(const Image& image, std::array<double, 3> expected, double tolerance = 1e-3) {
    const Vec3f linear =
        image.channels < 3
            ? linear_from_encoded(image.color_space, Vec3f::Constant(image.data[0]))
            : linear_from_encoded(image.color_space, {image.data[0], image.data[1], image.data[2]});
    for (int c = 0; c < 3; ++c) {
        INFO("channel " << c << ": " << linear[c]);
        CHECK(std::abs(double(linear[c]) - expected[static_cast<std::size_t>(c)]) < tolerance);
    }
}

}  // namespace

TEST_CASE("color: samples of a space of ours stay as they are, and one that is asked for counts most") {
    const Image made = pixel({0.2f, 0.4f, 0.6f});
    for (const ColorSpace space : {ColorSpace::kSrgb, ColorSpace::kDisplayP3, ColorSpace::kAdobeRgb}) {
        const Image read = settled({.icc = icc_from_color_space(space)}, made);
        CHECK(read.color_space == space);
        CHECK(read.data == made.data);
    }
    const StatedColor wide{.icc = matrix_profile(kD65, kRec2020, 2.4)};
    const Image asked = settled(wide, made, nullptr, ColorSpace::kRec709);
    CHECK(asked.color_space == ColorSpace::kRec709);
    CHECK(asked.data == made.data);
}

// BT.2087: linear Rec.2020 to Rec.709.
TEST_CASE("color: a matrix profile of other primaries and another curve is converted") {
    const float r = 0.6f, g = 0.5f, b = 0.4f;
    const double x = std::pow(0.6, 2.4), y = std::pow(0.5, 2.4), z = std::pow(0.4, 2.4);
    const std::array<double, 3> expected = {1.6605 * x - 0.5876 * y - 0.0728 * z,
                                            -0.1246 * x + 1.1329 * y - 0.0083 * z,
                                            -0.0182 * x - 0.1006 * y + 1.1187 * z};
    for (const double version : {2.1, 4.3}) {
        const Image read =
            settled({.icc = matrix_profile(kD65, kRec2020, 2.4, version)}, pixel({r, g, b, 0.3f}));
        CHECK(read.color_space == ColorSpace::kSrgb);
        CHECK(read.sample_type == SampleType::kUint8);
        CHECK(read.data[3] == 0.3f);  // alpha is no colour
        check_linear(read, expected);
        CHECK(std::abs(read.data[0] * 255 - std::round(read.data[0] * 255)) > 0.01f);  // not rounded again
    }
}

// The matrix from ProPhoto RGB (white D50) to linear sRGB by Bradford's adaptation (Lindbloom).
TEST_CASE("color: gamuts beyond ours are not clipped") {
    const Bytes gamma18 = matrix_profile(kD50, kProPhoto, 1.8);
    check_linear(settled({.icc = gamma18}, pixel({1, 1, 1})), {1, 1, 1});
    check_linear(settled({.icc = gamma18}, pixel({0.5f, 0.5f, 0.5f})),
                 {std::pow(0.5, 1.8), std::pow(0.5, 1.8), std::pow(0.5, 1.8)});
    const Image green = settled({.icc = gamma18}, pixel({0, 1, 0}, SampleType::kUint16));
    CHECK(green.color_space != ColorSpace::kSrgb);
    check_linear(green, {-0.7274, 1.2317, -0.1533}, 4e-3);
    const Image light =
        settled({.icc = matrix_profile(kD50, kProPhoto, 1)}, pixel({-0.5f, 2, 0}, SampleType::kFloat));
    CHECK(light.color_space == ColorSpace::kLinear);
    check_linear(light, {-0.5 * 2.0342 - 2 * 0.7274, 0.5 * 0.2288 + 2 * 1.2317, 0.5 * 0.0086 - 2 * 0.1533},
                 8e-3);
}

// A colour of P3 outside of sRGB, in a curve that is none of ours, ends in Display P3; one inside in sRGB.
TEST_CASE("color: the space is the first that holds the image") {
    constexpr cmsCIExyYTRIPLE kP3 = {{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}};
    constexpr cmsCIExyYTRIPLE kAdobe = {{0.64, 0.33, 1}, {0.21, 0.71, 1}, {0.15, 0.06, 1}};
    const StatedColor p3{.icc = matrix_profile(kD65, kP3, 1.8)},
        adobe{.icc = matrix_profile(kD65, kAdobe, 1.8)};
    CHECK(settled(p3, pixel({0.5f, 0.4f, 0.4f})).color_space == ColorSpace::kSrgb);
    CHECK(settled(p3, pixel({1, 0, 0})).color_space == ColorSpace::kDisplayP3);
    CHECK(settled(adobe, pixel({0, 1, 0})).color_space == ColorSpace::kAdobeRgb);
}

TEST_CASE("color: grey profiles") {
    const Image dark = settled({.icc = grey_profile(1.8)}, pixel({0.5f, 0.25f}));
    CHECK(dark.channel_names == Texts{"Y", "A"});
    CHECK(dark.data[1] == 0.25f);
    CHECK(dark.color_space == ColorSpace::kSrgb);
    const double light = std::pow(0.5, 1.8);
    check_linear(dark, {light, light, light});
    CHECK(settled({.icc = grey_profile(2.2)}, pixel({0.5f})).color_space == ColorSpace::kGamma22);
    CHECK(settled({.icc = grey_profile(2.2)}, pixel({0.5f})).data[0] == 0.5f);
    // Some writers leave the colour profile in an image that they have made grey.
    const double old = std::pow(0.5, 2.4);
    check_linear(settled({.icc = matrix_profile(kD65, kRec2020, 2.4)}, pixel({0.5f})), {old, old, old});
}

// L* is 50 where linear light is 0.18419.
TEST_CASE("color: tables to L*a*b*, of light and of ink, in version 2 and 4") {
    const auto lightness = [](const bool* c) { return cmsCIELab{100.0 * (c[0] + c[1] + c[2]) / 3, 0, 0}; };
    const auto paper = [](const bool* c) {
        return c[3]                     ? cmsCIELab{0, 0, 0}
               : c[0] && !c[1] && !c[2] ? cmsCIELab{60, -30, -40}
                                        : cmsCIELab{100, 0, 0};
    };
    for (const double version : {2.1, 4.2}) {
        INFO("version " << version);
        const StatedColor light{.icc = table_profile(cmsSigRgbData, cmsSigInputClass, version, lightness)};
        check_linear(settled(light, pixel({0.5f, 0.5f, 0.5f})), {0.18419, 0.18419, 0.18419});
        const double third = std::pow((100.0 / 3 + 16) / 116, 3);
        check_linear(settled(light, pixel({1, 0, 0})), {third, third, third});

        const StatedColor inks{.icc = table_profile(cmsSigCmykData, cmsSigOutputClass, version, paper),
                               .inks = true};
        const Image white = settled(inks, pixel({0, 0, 0, 0, 0.5f}));
        CHECK(white.channel_names.size() == 4);
        CHECK(white.data[3] == 0.5f);
        check_linear(white, {1, 1, 1});
        check_linear(settled(inks, pixel({0, 0, 0, 0.5f})), {0.18419, 0.18419, 0.18419});
        // L*a*b* (60, -30, -40) under D50 is this in linear sRGB, by Bradford's adaptation to D65.
        const Image cyan = settled(inks, pixel({1, 0, 0, 0}));
        CHECK(cyan.channel_names == Texts{"R", "G", "B"});
        check_linear(cyan, {-0.0709, 0.3572, 0.6755}, 1e-3);
        CHECK(settled(inks, pixel({0, 0, 0, 0.5f}), nullptr, ColorSpace::kLinear).color_space ==
              ColorSpace::kLinear);
    }
}

TEST_CASE("color: ink without a profile is mixed") {
    const Image mixed = settled({.inks = true}, pixel({0.25f, 0.5f, 1, 0.5f}));
    CHECK(mixed.color_space == ColorSpace::kSrgb);
    CHECK(mixed.data == std::vector<float>{0.375f, 0.25f, 0});
}

TEST_CASE("color: chromaticities and gamma") {
    constexpr Chromaticities kAdobe = {0.3127, 0.3290, 0.64, 0.33, 0.21, 0.71, 0.15, 0.06};
    CHECK(settled({.chromaticities = kAdobe, .gamma = 2.19925f}, pixel({0, 1, 0})).color_space ==
          ColorSpace::kAdobeRgb);
    CHECK(settled({.gamma = 2.2f}, pixel({0, 1, 0})).color_space == ColorSpace::kGamma22);
    const double light = std::pow(0.5, 1.8);
    check_linear(settled({.gamma = 1.8f}, pixel({0.5f, 0.5f, 0.5f})), {light, light, light});
    Texts warnings;
    const Chromaticities nothing = {0.3, 0.3, 0.5, 0.2, 0.5, 0.2, 0.5, 0.2};
    CHECK(settled({.chromaticities = nothing}, pixel({0.5f, 0, 0}), &warnings).data[0] == 0.5f);
    CHECK(warnings == Texts{"its chromaticities span no colours; its colours are read as sRGB"});
}

TEST_CASE("color: code points of H.273") {
    const Image made = pixel({0.5f, 0.25f, 0.75f});
    const auto space = [&](int primaries, int transfer) {
        const Image read = settled({.code_points = CodePoints{primaries, transfer}}, made);
        CHECK(read.data == made.data);
        return read.color_space;
    };
    CHECK(space(1, 13) == ColorSpace::kSrgb);
    CHECK(space(2, 2) == ColorSpace::kSrgb);
    CHECK(space(12, 13) == ColorSpace::kDisplayP3);
    CHECK(space(1, 8) == ColorSpace::kLinear);
    CHECK(space(1, 4) == ColorSpace::kGamma22);
    for (const int transfer : {1, 6, 14, 15}) CHECK(space(1, transfer) == ColorSpace::kRec709);
    // Rec.2020 in sRGB's curve.
    const double x = 0.21404, y = 0.05088, z = 0.52252;
    check_linear(settled({.code_points = CodePoints{9, 13}}, made),
                 {1.6605 * x - 0.5876 * y - 0.0728 * z, -0.1246 * x + 1.1329 * y - 0.0083 * z,
                  -0.0182 * x - 0.1006 * y + 1.1187 * z});
    // White is white, whatever white it is.
    for (const int primaries : {1, 4, 5, 6, 7, 8, 9, 11, 12, 22})
        for (const int transfer : {1, 4, 5, 6, 7, 8, 11, 12, 13, 14, 15})
            check_linear(settled({.code_points = CodePoints{primaries, transfer}}, pixel({1, 1, 1})),
                         {1, 1, 1}, 4e-3);
    Texts warnings;
    CHECK(settled({.code_points = CodePoints{10, 17}}, made, &warnings).data == made.data);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("10 and 17 of ITU-T H.273") != std::string::npos);
}

// BT.2408, table 1: the white of graphics, 203 cd/m2, is code 0.58 of PQ and 0.75 of HLG.
TEST_CASE("color: PQ and HLG are light above white") {
    const Image pq = settled({.code_points = CodePoints{9, 16}}, pixel({0.5807f, 0.5807f, 0.5807f}));
    CHECK(pq.color_space == ColorSpace::kLinear);
    CHECK(pq.sample_type == SampleType::kHalf);
    check_linear(pq, {1, 1, 1}, 2e-3);
    const Image brightest =
        settled({.code_points = CodePoints{12, 16}}, pixel({1, 1, 1}, SampleType::kUint16));
    CHECK(brightest.sample_type == SampleType::kFloat);
    check_linear(brightest, {10000 / 203.0, 10000 / 203.0, 10000 / 203.0}, 0.02);
    check_linear(settled({.code_points = CodePoints{9, 18}}, pixel({0.75f, 0.75f, 0.75f})), {1, 1, 1}, 3e-3);
    check_linear(settled({.code_points = CodePoints{9, 18}}, pixel({1, 1, 1})),
                 {1000 / 203.0, 1000 / 203.0, 1000 / 203.0}, 0.01);
    CHECK(settled({.code_points = CodePoints{9, 18}}, pixel({0, 0, 0})).data == std::vector<float>{0, 0, 0});
    const Image grey = settled({.code_points = CodePoints{9, 16}}, pixel({0.5807f}));
    CHECK(grey.channels == 1);
    check_linear(grey, {1, 1, 1}, 2e-3);
}

TEST_CASE("color: profiles that cannot be used are named, and the next statement counts") {
    const Image made = pixel({0.5f, 0.25f, 0.75f});
    Texts warnings;
    CHECK(settled({.icc = Bytes(200, 7)}, made, &warnings).data == made.data);
    CHECK(warnings == Texts{"its ICC profile is broken; its colours are read as sRGB"});
    const Bytes grey = grey_profile(1.8);
    CHECK(settled({.icc = grey}, made, &warnings).data == made.data);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("cannot be used for its channels; its colours are read as sRGB") !=
          std::string::npos);
    const auto lab = [](const bool*) { return cmsCIELab{100, 0, 0}; };
    const Bytes ink = table_profile(cmsSigCmykData, cmsSigOutputClass, 4.2, lab);
    CHECK(settled({.icc = ink}, made, &warnings).data == made.data);
    CHECK(warnings.size() == 1);
    cmsHPROFILE srgb = cmsCreate_sRGBProfile();
    cmsHTRANSFORM between = cmsCreateTransform(srgb, TYPE_RGB_8, srgb, TYPE_RGB_8, 0, 0);
    const Bytes link = saved(cmsTransform2DeviceLink(between, 4.3, 0));
    cmsDeleteTransform(between);
    cmsCloseProfile(srgb);
    CHECK(settled({.icc = link, .name = "linear"}, made, &warnings).color_space == ColorSpace::kLinear);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("read as linear") != std::string::npos);
    // Of a broken profile for ink only the ink is left.
    CHECK(settled({.icc = Bytes(200, 7), .inks = true}, pixel({0, 0, 0, 0}), &warnings).data ==
          std::vector<float>{1, 1, 1});
    CHECK(warnings.size() == 1);
}
