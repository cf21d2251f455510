// Which part, layer and channels of an EXR read_image() reads, and what becomes of their numbers.
#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfRgbaFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "formats/picture/color/primaries.h"
#include "formats/picture/decode/non_finite.h"
#include "tests/support/exr_files.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
using Names = std::vector<std::string>;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

std::vector<ExrPlane> joined(std::vector<ExrPlane> a, const std::vector<ExrPlane>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

ReadImageOptions colors_alone() {
    ReadImageOptions options;
    options.channels.emplace();
    return options;
}

// The value of the first pixel's channel.
float at(const Image& image, const char* name) {
    REQUIRE(image.channel(name) >= 0);
    return image.data[static_cast<std::size_t>(image.channel(name))];
}

}  // namespace

// As Blender names them: the colour is in a layer, and a normal has a Y that is no luminance.
TEST_CASE("exr: the layer with colour is the image, under its short names") {
    const TemporaryFolder folder;
    write_exr_file(folder / "b.exr", {{"", joined(exr_colors("ViewLayer.Combined", 0.5f, 0.25f, 0.125f),
                                                  {{"ViewLayer.Combined.A", 1},
                                                   {"ViewLayer.AO.X", 9},
                                                   {"ViewLayer.AO.Y", 9},
                                                   {"ViewLayer.Depth.Z", 7, Imf::FLOAT}})}});
    const ReadImage read = read_image_file(folder / "b.exr");
    CHECK(read.image.channel_names ==
          Names{"R", "G", "B", "A", "ViewLayer.AO.X", "ViewLayer.AO.Y", "ViewLayer.Depth.Z"});
    REQUIRE(read.place);
    CHECK(read.place->part == "0");
    CHECK(read.place->layer == "ViewLayer.Combined");
    CHECK(at(read.image, "B") == 0.125f);

    // Only the colour: nothing else counts, not even for the type of the samples.
    const Image color = read_image(folder / "b.exr", colors_alone());
    CHECK(color.channel_names == Names{"R", "G", "B", "A"});
    CHECK(color.sample_type == SampleType::kHalf);

    // Names of the layer, and full names of others; alpha comes along.
    ReadImageOptions options;
    options.channels = {"G", "ViewLayer.Depth.Z"};
    const Image named = read_image(folder / "b.exr", options);
    CHECK(named.channel_names == Names{"G", "A", "ViewLayer.Depth.Z"});
    CHECK(at(named, "ViewLayer.Depth.Z") == 7);
    options.channels = {"Z"};
    std::string text;
    CHECK(error_of([&] { read_image(folder / "b.exr", options); }, &text) == ErrorKind::kBadFile);
    CHECK(text.find("no channel Z, it has ViewLayer.AO.X") != std::string::npos);

    options = {.layer = "ViewLayer.Depth", .channels = Names{"Z"}};
    CHECK(at(read_image(folder / "b.exr", options), "Z") == 7);
    // A coordinate as Y would be taken for grey; that needs a word.
    options = {.layer = "ViewLayer.AO", .channels = Names{"X", "Y"}};
    CHECK(read_image_file(folder / "b.exr", options).warnings.size() == 1);
    options = {.layer = "Combined"};
    CHECK(error_of([&] { read_image(folder / "b.exr", options); }, &text) == ErrorKind::kBadFile);
    CHECK(text.find("no layer Combined, its layers are ViewLayer.AO, ViewLayer.Combined, ViewLayer.Depth") !=
          std::string::npos);
}

TEST_CASE("exr: an unnamed layer with colour comes before others, whatever their names") {
    const TemporaryFolder folder;
    // Two views: those of the left are without a prefix.
    write_exr_file(
        folder / "v.exr",
        {{"", joined(exr_colors("", 0.5f, 0.5f, 0.5f), exr_colors("right", 0.25f, 0.25f, 0.25f))}});
    CHECK(at(read_image(folder / "v.exr"), "R") == 0.5f);
    CHECK(at(read_image(folder / "v.exr", {.layer = "right"}), "R") == 0.25f);
    CHECK(read_image_file(folder / "v.exr", {.layer = "right"}).place->layer == "right");
    CHECK(read_image_file(folder / "v.exr").place->layer == "");  // there was a choice

    // Grey without a name before colour with one; among the named, colour first.
    write_exr_file(folder / "g.exr", {{"", joined({{"Y", 1}}, exr_colors("d", 0, 0, 0))}});
    CHECK(read_image(folder / "g.exr", colors_alone()).channel_names == Names{"Y"});
    write_exr_file(folder / "n.exr", {{"", joined({{"a.Y", 1}}, exr_colors("d", 0, 0, 0))}});
    CHECK(read_image_file(folder / "n.exr").place->layer == "d");
    // Words instead of letters, as Nuke may write them.
    write_exr_file(folder / "w.exr", {{"", {{"d.red", 1}, {"d.green", 2}, {"d.blue", 3}, {"d.alpha", 1}}}});
    CHECK(read_image(folder / "w.exr").channel_names == Names{"R", "G", "B", "A"});
    CHECK(at(read_image(folder / "w.exr"), "G") == 2);
    // Nothing to choose from.
    write_exr_file(folder / "p.exr", {{"", exr_colors("", 0, 0, 0)}});
    CHECK_FALSE(read_image_file(folder / "p.exr").place);
}

TEST_CASE("exr: parts by name and number; the first with colour") {
    const TemporaryFolder folder;
    write_exr_file(folder / "m.exr", {{"depth", {{"Z", kInf, Imf::FLOAT}}},
                                      {"1", exr_colors("", 0.5f, 0, 0)},
                                      {"beauty", joined(exr_colors("", 0.25f, 0, 0), {{"id", 3}})}});
    const auto red = [&](const ReadImageOptions& options) {
        return at(read_image(folder / "m.exr", options), "R");
    };
    CHECK(red({}) == 0.5f);
    CHECK(read_image_file(folder / "m.exr").place->part == "1");
    CHECK(red({.part = "beauty"}) == 0.25f);
    CHECK(red({.part = "2"}) == 0.25f);
    CHECK(red({.part = "1"}) == 0.5f);  // a name comes before a number
    // Channels decide where neither part nor layer is given.
    CHECK(read_image_file(folder / "m.exr", {.channels = Names{"R", "id"}}).place->part == "beauty");
    std::string text;
    for (const std::string name : {"3", "-1", "", "1x", "Beauty"}) {
        CHECK(error_of([&] { read_image(folder / "m.exr", {.part = name}); }, &text) == ErrorKind::kBadFile);
        CHECK(text.find("its parts are depth, 1, beauty") != std::string::npos);
    }
    CHECK(error_of([&] { read_image(folder / "m.exr", {.layer = "no"}); }, &text) == ErrorKind::kBadFile);
    CHECK(text.find("its layers are (unnamed)") != std::string::npos);
}

TEST_CASE("exr: what is not asked for is neither read nor checked") {
    const TemporaryFolder folder;
    std::vector<ExrPlane> planes = exr_colors("", 0.5f, 0.5f, 0.5f);
    planes.push_back({"Z", kInf, Imf::FLOAT});
    planes.push_back({"nan", kNan, Imf::FLOAT});
    planes.push_back({"small", 0, Imf::UINT, {}, 1, (1u << 24) - 1});
    planes.push_back({"large", 0, Imf::UINT, {}, 1, 1u << 24});
    planes.push_back({"sub", 0, Imf::HALF, {}, 2});
    for (int i = 0; i < 64; ++i) planes.push_back({cat("zmask", i), 1});
    write_exr_file(folder / "f.exr", {{"", planes}});
    const ReadImage color = read_image_file(folder / "f.exr", colors_alone());
    CHECK(color.image.channel_names == Names{"R", "G", "B"});
    CHECK(color.warnings.empty());

    const auto fails = [&](const Names& channels, ErrorKind kind, const std::string& word) {
        std::string text;
        CHECK(error_of([&] { read_image(folder / "f.exr", {.channels = channels}); }, &text) == kind);
        CHECK(text.find(word) != std::string::npos);
    };
    fails({"R", "Z"}, ErrorKind::kBadFile, "channel Z of pixel (0, 0) is not a finite number");
    fails({"nan"}, ErrorKind::kBadFile, "channel nan of pixel");
    fails({"large"}, ErrorKind::kUnsupported, "channel large holds integers of 2^24 and more");
    fails({"sub"}, ErrorKind::kUnsupported, "channel sub is subsampled");
    CHECK(at(read_image(folder / "f.exr", {.channels = Names{"small"}}), "small") == 16777215);

    // All channels: what cannot be read is named, and 64 are the most.
    ReadImageOptions all;
    const ReadImage read = read_image_file(folder / "f.exr", all);
    CHECK(read.image.channel("small") >= 0);
    for (const char* name : {"Z", "nan", "large", "sub"}) {
        CHECK(read.image.channel(name) < 0);
        CHECK(std::ranges::count_if(read.warnings, [&](const std::string& warning) {
                  return warning.find(cat("channel ", name, " is left out")) == 0;
              }) == 1);
    }
    CHECK(read.image.channels <= 64);
}

TEST_CASE("exr: samples that are not finite become 0 or the nearest") {
    const TemporaryFolder folder;
    // In a row of 5: a tie goes to the left.
    write_exr_file(folder / "n.exr",
                   {{"",
                     {{"R", 0, Imf::FLOAT, {1, kNan, 3, kInf, -kInf}},
                      {"G", 0.5f, Imf::FLOAT},
                      {"B", 0.5f, Imf::FLOAT},
                      {"A", 1, Imf::FLOAT, {1, 1, 1, 1, kNan}}}}},
                   5, 1);
    CHECK(error_of([&] { read_image(folder / "n.exr"); }) == ErrorKind::kBadFile);
    const auto reds = [&](NonFinite how) {
        const ReadImage read = read_image_file(folder / "n.exr", {.non_finite = how});
        CHECK(read.non_finite == 4);
        REQUIRE(read.warnings.size() == 1);
        CHECK(read.warnings[0].find("not finite") != std::string::npos);
        CHECK(read.warnings[0].ends_with(": 4"));
        std::vector<float> out;
        for (std::size_t i = 0; i < 5; ++i) out.push_back(read.image.pixel(i)[0]);
        return out;
    };
    CHECK(reds(NonFinite::kZero) == std::vector<float>{1, 0, 3, 0, 0});
    CHECK(reds(NonFinite::kNearest) == std::vector<float>{1, 1, 3, 3, 3});
    write_exr_file(folder / "z.exr", {{"", exr_colors("", kNan, 0, 0)}});
    CHECK(error_of([&] { read_image(folder / "z.exr", {.non_finite = NonFinite::kNearest}); }) ==
          ErrorKind::kBadFile);
    // Other formats too.
    write_with_oiio(folder / "t.tif", read_image(folder / "n.exr", {.non_finite = NonFinite::kZero}),
                    OIIO::TypeFloat);
    Image tiff = read_image(folder / "t.tif");
    tiff.pixel(2, 0)[1] = kNan;
    write_with_oiio(folder / "t.tif", tiff, OIIO::TypeFloat);
    CHECK(read_image_file(folder / "t.tif", {.non_finite = NonFinite::kNearest}).non_finite == 1);
}

// Against the slow way, with its rule of ties: leftmost column, then the upper row.
TEST_CASE("exr: the nearest finite sample of every pixel") {
    std::mt19937 random(7);
    for (int round = 0; round < 60; ++round) {
        const int width = 1 + static_cast<int>(random() % 14), height = 1 + static_cast<int>(random() % 14);
        Image image = make_image(width, height, 2);
        const auto rare = 1 + random() % 9;
        for (std::size_t i = 0; i < image.pixel_count(); ++i) {
            image.pixel(i)[0] = 1;
            image.pixel(i)[1] = random() % rare == 0 ? static_cast<float>(i) : kNan;
        }
        image.pixel(random() % image.pixel_count())[1] = 0.5f;
        Image filled = image;
        fill_non_finite(filled, 1);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                float best = kNan;
                int least = std::numeric_limits<int>::max();
                for (int u = 0; u < width; ++u)
                    for (int v = 0; v < height; ++v) {
                        const int d = (u - x) * (u - x) + (v - y) * (v - y);
                        if (!std::isfinite(image.pixel(u, v)[1]) || d >= least) continue;
                        least = d;
                        best = image.pixel(u, v)[1];
                    }
                CHECK(filled.pixel(x, y)[1] == best);
                CHECK(filled.pixel(x, y)[0] == 1);
            }
    }
}

// OpenEXR's own class reads the same file, if it is in the first part and in halves.
TEST_CASE("exr: luminance and chroma are RGB as OpenEXR makes it") {
    const TemporaryFolder folder;
    std::mt19937 random(3);
    for (const auto& [width, height] : {std::pair(2, 2), std::pair(16, 2), std::pair(38, 44)}) {
        Imf::Array2D<Imf::Rgba> made(height, width);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                made[y][x] =
                    Imf::Rgba(static_cast<float>(random() % 100) / 50, 0.2f + 0.01f * static_cast<float>(x),
                              static_cast<float>(x > y), 0.5f + 0.01f * static_cast<float>(y));
        const Imath::Box2i window({-4, 2}, {width - 5, height + 1});
        {
            Imf::Header header(window, window);
            Imf::RgbaOutputFile file((folder / "y.exr").c_str(), header, Imf::WRITE_YCA);
            file.setFrameBuffer(&made[0][0] + 4 - 2 * width, 1, static_cast<std::size_t>(width));
            file.writePixels(height);
        }
        Imf::Array2D<Imf::Rgba> expected(height, width);
        {
            Imf::RgbaInputFile file((folder / "y.exr").c_str());
            file.setFrameBuffer(&expected[0][0] + 4 - 2 * width, 1, static_cast<std::size_t>(width));
            file.readPixels(window.min.y, window.max.y);
        }
        const Image read = read_image(folder / "y.exr");
        REQUIRE(read.channel_names == Names{"R", "G", "B", "A"});
        CHECK(read.sample_type == SampleType::kHalf);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const Imf::Rgba& e = expected[y][x];
                CHECK(read.pixel(x, y)[0] == float(e.r) / float(e.a));
                CHECK(read.pixel(x, y)[1] == float(e.g) / float(e.a));
                CHECK(read.pixel(x, y)[2] == float(e.b) / float(e.a));
                CHECK(read.pixel(x, y)[3] == float(e.a));
            }
        // One of the three alone, and the luminance itself.
        CHECK(read_image(folder / "y.exr", {.channels = Names{"B"}}).pixel(1, 1)[0] == read.pixel(1, 1)[2]);
        CHECK(read_image(folder / "y.exr", {.channels = Names{"Y"}}).channel_names == Names{"Y", "A"});
    }
    // Chroma in a layer of a later part.
    const std::vector<ExrPlane> planes = {
        {"l.Y", 0.5f}, {"l.RY", 0, Imf::HALF, {}, 2}, {"l.BY", 0, Imf::HALF, {}, 2}};
    write_exr_file(folder / "p.exr", {{"z", {{"Z", 1}}}, {"c", planes}});
    CHECK(at(read_image(folder / "p.exr", colors_alone()), "B") == 0.5f);
    // Chroma of other samplings is refused.
    write_exr_file(folder / "s.exr", {{"", {{"Y", 0.5f}, {"RY", 0}, {"BY", 0}}}});
    CHECK(error_of([&] { read_image(folder / "s.exr"); }) == ErrorKind::kUnsupported);
}

TEST_CASE("exr: other primaries become Rec.709's") {
    const TemporaryFolder folder;
    const auto read = [&](const std::vector<ExrPlane>& planes,
                          const std::function<void(Imf::Header&)>& change,
                          const ReadImageOptions& options = {}) {
        write_exr_file(folder / "p.exr", {{"", planes, change}});
        return read_image(folder / "p.exr", options);
    };
    const auto with = [](const Imf::Chromaticities& c) {
        return [c](Imf::Header& header) { Imf::addChromaticities(header, c); };
    };
    // ACEScg (AP1, white of ACES). Its matrix to Rec.709 is published with Bradford's adaptation.
    const Imf::Chromaticities ap1({0.713f, 0.293f}, {0.165f, 0.830f}, {0.128f, 0.044f}, {0.32168f, 0.33767f});
    const Image red = read(exr_colors("", 1, 0, 0), with(ap1));
    CHECK(at(red, "R") == doctest::Approx(1.70505).epsilon(1e-4));
    CHECK(at(red, "G") == doctest::Approx(-0.13026).epsilon(1e-4));
    CHECK(at(red, "B") == doctest::Approx(-0.02400).epsilon(1e-3));
    // White stays white, and so does light above it.
    for (const float white : {1.0f, 4.0f}) {
        const Image image = read(exr_colors("", white, white, white), with(ap1));
        for (const char* name : {"R", "G", "B"})
            CHECK(at(image, name) == doctest::Approx(white).epsilon(1e-5));
    }
    // Display P3 and Rec.2020 have our white: the matrices are those of CSS Color 4.
    const Imath::V2f d65(0.3127f, 0.3290f);
    const Image p3 =
        read(exr_colors("", 0, 1, 0), with({{0.680f, 0.320f}, {0.265f, 0.690f}, {0.150f, 0.060f}, d65}));
    CHECK(at(p3, "R") == doctest::Approx(-0.22494).epsilon(1e-4));
    const Image wide =
        read(exr_colors("", 0, 1, 0), with({{0.708f, 0.292f}, {0.170f, 0.797f}, {0.131f, 0.046f}, d65}));
    CHECK(at(wide, "R") == doctest::Approx(-0.58764).epsilon(1e-4));
    // A flag alone means AP0.
    const auto aces = [](Imf::Header& header) {
        header.insert("acesImageContainerFlag", Imf::IntAttribute(1));
    };
    CHECK(at(read(exr_colors("", 1, 0, 0), aces), "R") == doctest::Approx(2.52169).epsilon(1e-4));
    // Grey has no primaries, and a colour space that was given counts more.
    CHECK(at(read({{"Y", 0.5f}}, with(ap1)), "Y") == 0.5f);
    CHECK(at(read(exr_colors("", 1, 0, 0), with(ap1), {.color_space = ColorSpace::kLinear}), "R") == 1);
    // No triangle, no numbers, a white without light.
    const Imath::V2f red709(0.64f, 0.33f), blue709(0.15f, 0.06f);
    const Imf::Chromaticities nothing[] = {
        {red709, red709}, {red709, {kNan, 1}}, {red709, {0.3f, 0.6f}, blue709, {1, 0}}};
    for (const Imf::Chromaticities& c : nothing)
        CHECK(error_of([&] { read(exr_colors("", 1, 0, 0), with(c)); }) == ErrorKind::kBadFile);
}

TEST_CASE("exr: a flat part beside a deep one is read") {
    const TemporaryFolder folder;
    const auto write = [&](bool flat_too) {
        std::vector<Imf::Header> headers(flat_too ? 2 : 1, Imf::Header(1, 1));
        headers[0].setName("deep");
        headers[0].setType(Imf::DEEPSCANLINE);
        headers[0].compression() = Imf::ZIPS_COMPRESSION;
        headers[0].channels().insert("Y", Imf::Channel(Imf::FLOAT));
        if (flat_too) {
            headers[1].setName("flat");
            headers[1].setType(Imf::SCANLINEIMAGE);
            headers[1].channels().insert("Y", Imf::Channel(Imf::FLOAT));
        }
        Imf::MultiPartOutputFile file((folder / "d.exr").c_str(), headers.data(),
                                      static_cast<int>(headers.size()));
        Imf::DeepScanLineOutputPart deep(file, 0);
        unsigned count = 0;
        float* samples = nullptr;
        Imf::DeepFrameBuffer deep_buffer;
        deep_buffer.insertSampleCountSlice(Imf::Slice(Imf::UINT, reinterpret_cast<char*>(&count), 4, 4));
        deep_buffer.insert("Y", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(&samples), 8, 8, 4));
        deep.setFrameBuffer(deep_buffer);
        deep.writePixels(1);
        if (!flat_too) return;
        float value = 0.5f;
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&value), 4, 4));
        Imf::OutputPart flat(file, 1);
        flat.setFrameBuffer(buffer);
        flat.writePixels(1);
    };
    write(true);
    CHECK(read_image(folder / "d.exr").data == std::vector<float>{0.5f});
    std::string text;
    CHECK(error_of([&] { read_image(folder / "d.exr", {.part = "deep"}); }, &text) ==
          ErrorKind::kUnsupported);
    CHECK(text.find("deep") != std::string::npos);
    write(false);
    CHECK(error_of([&] { read_image(folder / "d.exr"); }) == ErrorKind::kUnsupported);
}

TEST_CASE("exr: an image without colour says what it has") {
    const TemporaryFolder folder;
    write_exr_file(folder / "u.exr", {{"", {{"R", 0, Imf::UINT, {}, 1, 9}, {"Z", kNan}}}});
    std::string text;
    CHECK(error_of([&] { read_image(folder / "u.exr", colors_alone()); }, &text) == ErrorKind::kUnsupported);
    CHECK(text.find("no colour, neither channels R, G, B nor Y, but R (integers), Z") != std::string::npos);
    CHECK(at(read_image(folder / "u.exr"), "R") == 9);
}
