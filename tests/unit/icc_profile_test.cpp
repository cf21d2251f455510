// Which colour space a profile is taken for, and that those written are what other software expects.
#include <doctest/doctest.h>
#include <lcms2.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "formats/picture/color/icc_profile.h"
#include "tests/support/icc_bytes.h"

using namespace imgmesh;
using test::saved;
using Bytes = std::vector<std::uint8_t>;

namespace {

constexpr ColorSpace kSpaces[] = {ColorSpace::kSrgb,    ColorSpace::kLinear,   ColorSpace::kRec709,
                                  ColorSpace::kGamma22, ColorSpace::kAdobeRgb, ColorSpace::kDisplayP3};

constexpr cmsCIExyY kD65 = {0.3127, 0.3290, 1};
constexpr cmsCIExyYTRIPLE kSrgbPrimaries = {{0.64, 0.33, 1}, {0.30, 0.60, 1}, {0.15, 0.06, 1}};
constexpr cmsCIExyYTRIPLE kRec2020Primaries = {{0.708, 0.292, 1}, {0.170, 0.797, 1}, {0.131, 0.046, 1}};

// A profile of three curves, which it frees.
Bytes matrix_profile(const cmsCIExyYTRIPLE& primaries, std::array<cmsToneCurve*, 3> curves,
                     double version = 4.3) {
    const Bytes bytes = saved(cmsCreateRGBProfile(&kD65, &primaries, curves.data()), version);
    for (cmsToneCurve* curve : curves) cmsFreeToneCurve(curve);
    return bytes;
}

cmsToneCurve* power(double g) {
    return cmsBuildGamma(nullptr, g);
}

// sRGB's curve at `size` steps, as profiles of version 2 have it.
cmsToneCurve* srgb_table(std::size_t size) {
    std::vector<cmsUInt16Number> table;
    for (std::size_t i = 0; i < size; ++i) {
        const double x = static_cast<double>(i) / static_cast<double>(size - 1);
        const double y = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
        table.push_back(static_cast<cmsUInt16Number>(std::lround(y * 65535)));
    }
    return cmsBuildTabulatedToneCurve16(nullptr, static_cast<cmsUInt32Number>(size), table.data());
}

}  // namespace

TEST_CASE("icc: a written profile is its own space, and the same bytes each time") {
    for (const ColorSpace space : kSpaces) {
        const Bytes bytes = icc_from_color_space(space);
        CHECK(color_space_from_icc(bytes) == space);
        CHECK(bytes == icc_from_color_space(space));
        // The date of the header, which Little CMS would make that of now.
        const Bytes date(bytes.begin() + 24, bytes.begin() + 36);
        CHECK(date == Bytes{0x07, 0xD0, 0, 1, 0, 1, 0, 12, 0, 0, 0, 0});
    }
}

TEST_CASE("icc: other software's profiles of our spaces") {
    CHECK(color_space_from_icc(saved(cmsCreate_sRGBProfile())) == ColorSpace::kSrgb);
    CHECK(color_space_from_icc(saved(cmsCreate_sRGBProfile(), 2.1)) == ColorSpace::kSrgb);
    for (const std::size_t size : {1024, 4096, 64})
        CHECK(color_space_from_icc(matrix_profile(
                  kSrgbPrimaries, {srgb_table(size), srgb_table(size), srgb_table(size)}, 2.1)) ==
              ColorSpace::kSrgb);
    // Version 2 holds a power in 1/256: 563/256 for 2.2.
    CHECK(color_space_from_icc(matrix_profile(kSrgbPrimaries, {power(2.2), power(2.2), power(2.2)}, 2.1)) ==
          ColorSpace::kGamma22);
    CHECK(color_space_from_icc(matrix_profile(kSrgbPrimaries, {power(1), power(1), power(1)}, 2.1)) ==
          ColorSpace::kLinear);
}

TEST_CASE("icc: other curves, other primaries and other models are none of our spaces") {
    CHECK_FALSE(color_space_from_icc(matrix_profile(kSrgbPrimaries, {power(1.8), power(1.8), power(1.8)})));
    CHECK_FALSE(color_space_from_icc(matrix_profile(kSrgbPrimaries, {power(2.2), power(2.2), power(1.8)})));
    CHECK_FALSE(
        color_space_from_icc(matrix_profile(kRec2020Primaries, {power(2.2), power(2.2), power(2.2)})));
    const cmsCIExyYTRIPLE swapped = {kSrgbPrimaries.Green, kSrgbPrimaries.Red, kSrgbPrimaries.Blue};
    CHECK_FALSE(color_space_from_icc(matrix_profile(swapped, {power(2.2), power(2.2), power(2.2)})));
    cmsToneCurve* const curve = power(1.8);
    CHECK_FALSE(color_space_from_icc(saved(cmsCreateGrayProfile(&kD65, curve))));
    cmsFreeToneCurve(curve);
    CHECK_FALSE(color_space_from_icc(saved(cmsCreateLab4Profile(nullptr))));
    CHECK_FALSE(color_space_from_icc(saved(cmsCreateXYZProfile())));
}

// The tables turn colours around; a reader that knows no tables sees sRGB, and so do we.
TEST_CASE("icc: of a profile with tables the matrix counts") {
    cmsHPROFILE profile = cmsCreate_sRGBProfile();
    cmsPipeline* const table = cmsPipelineAlloc(nullptr, 3, 3);
    constexpr cmsFloat64Number kTurned[] = {0, 0, 1, 1, 0, 0, 0, 1, 0};
    // The format wants curves around a matrix.
    for (cmsStage* stage :
         {cmsStageAllocToneCurves(nullptr, 3, nullptr), cmsStageAllocMatrix(nullptr, 3, 3, kTurned, nullptr),
          cmsStageAllocToneCurves(nullptr, 3, nullptr)})
        REQUIRE(cmsPipelineInsertStage(table, cmsAT_END, stage));
    REQUIRE(cmsWriteTag(profile, cmsSigAToB0Tag, table));
    cmsPipelineFree(table);
    CHECK(color_space_from_icc(saved(profile)) == ColorSpace::kSrgb);
}

// What is left of a profile is none, or still the same space where nothing that counts was hit.
TEST_CASE("icc: broken profiles are safe") {
    CHECK_FALSE(color_space_from_icc({}));
    CHECK_FALSE(color_space_from_icc(Bytes(200, 7)));
    const Bytes sound = icc_from_color_space(ColorSpace::kAdobeRgb);
    for (std::size_t size = 0; size < sound.size(); size += 3)
        color_space_from_icc(std::span(sound).first(size));
    CHECK_FALSE(color_space_from_icc(std::span(sound).first(130)));
    // All numbers of the header and of the table of tags, made the largest.
    for (std::size_t at = 0; at + 4 <= 128 + 4 + 12 * 13; at += 4) {
        Bytes bytes = sound;
        std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), 4, std::uint8_t{0xFF});
        const auto space = color_space_from_icc(bytes);
        CHECK((!space || *space == ColorSpace::kAdobeRgb));
    }
    std::mt19937 random(5);
    for (int round = 0; round < 2000; ++round) {
        Bytes bytes = sound;
        for (int i = 0; i < 3; ++i) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
        color_space_from_icc(bytes);
    }
    Bytes long_one = sound;
    long_one.resize((std::size_t{16} << 20) + 1);
    CHECK_FALSE(color_space_from_icc(long_one));
}
