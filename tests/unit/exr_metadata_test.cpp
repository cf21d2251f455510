// What the header of an EXR says, from one EXR to another.
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <doctest/doctest.h>

#include <limits>

#include "formats/exr/exr_metadata.h"
#include "tests/support/exr_files.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

// The header of an EXR's first part.
Imf::Header header_of(const std::string& path) {
    return Imf::MultiPartInputFile(path.c_str()).header(0);
}

}  // namespace

TEST_CASE("exr: what a header says comes back in the EXR that is written") {
    const TemporaryFolder folder;
    const std::string in = folder / "in.exr", out = folder / "out.exr";
    const Imath::Box2i shown({10, 20}, {13, 23}), stored({11, 20}, {12, 22});
    const Imf::Chromaticities p3({0.680f, 0.320f}, {0.265f, 0.690f}, {0.150f, 0.060f}, {0.3127f, 0.3290f});
    write_exr_file(in, {{"", exr_colors("", 0.5f, 0.25f, 0.125f), [&](Imf::Header& header) {
                             header.displayWindow() = shown;
                             header.dataWindow() = stored;
                             header.pixelAspectRatio() = 2;
                             header.screenWindowCenter() = {0.5f, -1};
                             Imf::addOwner(header, "Ann");
                             Imf::addComments(header, "two\nlines, \u00e4");
                             Imf::addCapDate(header, "2026:11:28 01:02:03");
                             Imf::addExpTime(header, 0.1f);
                             Imf::addFramesPerSecond(header, Imf::Rational(24000, 1001));
                             Imf::addTimeCode(header, Imf::TimeCode(1, 2, 3, 4));
                             Imf::addChromaticities(header, p3);
                             Imf::addWorldToCamera(
                                 header, Imath::M44f(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16));
                             header.insert("shot", Imf::StringAttribute("010"));
                             header.insert("take", Imf::IntAttribute(-7));
                             header.insert("acesImageContainerFlag", Imf::IntAttribute(0));
                         }}});
    const ReadImage read = read_image_file(in);
    CHECK(read.warnings.empty());
    CHECK(exr_metadata_fault(read.metadata, 4, 4).empty());
    CHECK(find_attribute(read.metadata, "compression") == nullptr);
    CHECK(find_attribute(read.metadata, "acesImageContainerFlag") == nullptr);
    CHECK(read.image.pixel(0, 0)[0] == 0);  // outside the data window
    write_image(out, read.image, {.sample_type = {}, .metadata = read.metadata});

    const Imf::Header was = header_of(in), is = header_of(out);
    CHECK(is.displayWindow() == shown);
    CHECK(is.dataWindow() == stored);
    CHECK(is.pixelAspectRatio() == 2);
    CHECK(is.screenWindowCenter() == Imath::V2f(0.5f, -1));
    CHECK(Imf::owner(is) == "Ann");
    CHECK(Imf::comments(is) == Imf::comments(was));
    CHECK(Imf::capDate(is) == "2026:11:28 01:02:03");
    CHECK(Imf::expTime(is) == 0.1f);
    CHECK(Imf::framesPerSecond(is) == Imf::Rational(24000, 1001));
    CHECK(Imf::timeCode(is) == Imf::TimeCode(1, 2, 3, 4));
    CHECK(Imf::worldToCamera(is) == Imf::worldToCamera(was));
    CHECK(Imf::chromaticities(is) == p3);
    CHECK(is.typedAttribute<Imf::StringAttribute>("shot").value() == "010");
    CHECK(is.typedAttribute<Imf::IntAttribute>("take").value() == -7);
    // The numbers are in the file's primaries again.
    const Image numbers = read_image(out, {.color_space = ColorSpace::kLinear});
    CHECK(numbers.pixel(1, 0)[0] == doctest::Approx(0.5).epsilon(1e-3));
    CHECK(numbers.pixel(1, 0)[2] == doctest::Approx(0.125).epsilon(1e-3));
    // Another size has other windows, and numbers taken for Rec.709's have no chromaticities.
    write_image(out, make_image(3, 2, 3), {.sample_type = SampleType::kHalf, .metadata = read.metadata});
    CHECK(header_of(out).dataWindow() == Imath::Box2i({0, 0}, {2, 1}));
    CHECK(find_attribute(read_image_file(in, {.color_space = ColorSpace::kLinear}).metadata,
                         "chromaticities") == nullptr);
}

TEST_CASE("exr: a usual header says nothing, and pixels beyond the image are lost with a word") {
    const TemporaryFolder folder;
    write_exr_file(folder / "u.exr", {{"", exr_colors("", 1, 1, 1)}});
    CHECK(read_image_file(folder / "u.exr").metadata.empty());
    write_exr_file(folder / "o.exr", {{"", exr_colors("", 1, 1, 1), [](Imf::Header& header) {
                                           header.dataWindow() = {{-2, -2}, {5, 1}};
                                       }}});
    const ReadImage read = read_image_file(folder / "o.exr");
    REQUIRE(read.warnings.size() == 1);
    CHECK(read.warnings[0].find("beyond its display window") != std::string::npos);
    write_image(folder / "w.exr", read.image, {.sample_type = {}, .metadata = read.metadata});
    CHECK(header_of(folder / "w.exr").displayWindow() == Imath::Box2i({0, 0}, {3, 3}));
    CHECK(header_of(folder / "w.exr").dataWindow() == Imath::Box2i({0, 0}, {3, 1}));
}

TEST_CASE("exr: attributes that are too long, too many or no text are named in a warning") {
    const TemporaryFolder folder;
    const auto read = [&](const std::function<void(Imf::Header&)>& change) {
        write_exr_file(folder / "a.exr", {{"", exr_colors("", 1, 1, 1), change}});
        return read_image_file(folder / "a.exr");
    };
    const ReadImage odd = read([](Imf::Header& header) {
        header.insert("good", Imf::StringAttribute("kept"));
        header.insert("latin", Imf::StringAttribute("caf\xe9"));
        header.insert("bell", Imf::StringAttribute("\a"));
        header.insert("long", Imf::StringAttribute(std::string(kMaxMetadataBytes, 'x')));
        header.insert("nan", Imf::FloatAttribute(kNan));
    });
    CHECK(odd.metadata == ExrMetadata{{"good", "string", "kept", {}}});
    REQUIRE(odd.warnings.size() == 1);
    for (const char* name : {"latin", "bell", "long", "nan"})
        CHECK(odd.warnings[0].find(name) != std::string::npos);
    const ReadImage many = read([](Imf::Header& header) {
        for (int i = 0; i < 300; ++i) header.insert(cat("n", i), Imf::IntAttribute(i));
    });
    CHECK(many.metadata.size() == kMaxMetadataEntries);
    CHECK(many.warnings[0].find("and 39 more") != std::string::npos);
}

TEST_CASE("exr: metadata of others' containers are checked") {
    const auto fault = [](const ExrAttribute& a) { return !exr_metadata_fault({a}, 4, 4).empty(); };
    CHECK_FALSE(fault({"x", "int", "", {3}}));
    CHECK_FALSE(fault({"x", "timecode", "", {4294967295.0, 0}}));
    CHECK_FALSE(fault({"displayWindow", "box2i", "", {-1, 0, 2, 3}}));
    CHECK(fault({"", "int", "", {3}}));
    CHECK(fault({"a\nb", "int", "", {3}}));
    CHECK(fault({"x", "preview", "", {}}));
    CHECK(fault({"x", "int", "", {}}));
    CHECK(fault({"x", "int", "", {0.5}}));
    CHECK(fault({"x", "int", "", {3e9}}));
    CHECK(fault({"x", "int", "text", {3}}));
    CHECK(fault({"x", "float", "", {1e39}}));
    CHECK(fault({"x", "double", "", {double(kInf)}}));
    CHECK(fault({"x", "string", "\xff", {}}));
    CHECK(fault({"x", "string", "\xc0\x80", {}}));
    CHECK(fault({"x", "string", std::string("a\0b", 3), {}}));
    CHECK(fault({"type", "string", "deepscanline", {}}));
    CHECK(fault({"imgmesh:version", "string", "1.0", {}}));
    CHECK(fault({"dataWindow", "v2i", "", {1, 2}}));
    CHECK(fault({"dataWindow", "box2i", "", {3, 0, 2, 0}}));
    CHECK(fault({"dataWindow", "box2i", "", {-2147483648.0, 0, 2147483647, 0}}));
    CHECK(fault({"displayWindow", "box2i", "", {0, 0, 4, 3}}));
    CHECK(fault({"pixelAspectRatio", "float", "", {0}}));
    CHECK_FALSE(exr_metadata_fault({{"b", "int", "", {1}}, {"a", "int", "", {1}}}, 4, 4).empty());
    CHECK_FALSE(exr_metadata_fault(ExrMetadata(257, {"a", "int", "", {1}}), 4, 4).empty());
}
