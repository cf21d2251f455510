// A picture of many files is read as the picture that they are side by side.
#include <doctest/doctest.h>

#include <filesystem>

#include "libcore/base/error.h"
#include "tests/support/region_checks.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

Image busy(int width, int height, int channels = 3) {
    Image image = make_image(width, height, channels);
    for (std::size_t i = 0; i < image.data.size(); ++i)
        image.data[i] = static_cast<float>((i * 37 + i / 61) % 256) / 255.0f;
    return image;
}

Image cut(const Image& image, const PixelRect& r) {
    Image out = make_image(r.width(), r.height(), image.channels);
    for (int y = 0; y < r.height(); ++y)
        std::copy_n(image.pixel(r.left, r.top + y), r.width() * image.channels, out.pixel(0, y));
    return out;
}

void save_text(const std::string& path, const std::string& text) {
    save(path, {text.begin(), text.end()});
}

// All of the source is `whole`, by regions.
void check_is(const std::string& path, const Image& whole) {
    const RegionSource source(path);
    CHECK(source.facts().access == RegionAccess::kDirect);
    REQUIRE(source.facts().width == whole.width);
    REQUIRE(source.facts().height == whole.height);
    ReadImage expected;
    expected.image = whole;
    constexpr int kStep = 23;
    for (int y = 0; y < whole.height; y += kStep)
        for (int x = 0; x < whole.width; x += kStep) {
            const PixelRect region{x, y, std::min(x + kStep, whole.width), std::min(y + kStep, whole.height)};
            check_part(source.read_region(region), expected, region);
        }
}

std::string failure(const std::string& path, const PixelRect& region = {0, 0, 1, 1}) {
    try {
        (void)RegionSource(path).read(region);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}
bool names(const std::string& text, const std::string& part) {
    INFO(text);
    return text.find(part) != std::string::npos;
}

// A picture of 70 x 50 pixels as files of 32 x 20, and their list.
struct Tiles {
    const TemporaryFolder folder;
    const Image image = busy(70, 50);

    explicit Tiles(const std::string& extension, const std::string& prefix = "t_") {
        std::filesystem::create_directory(folder.path() / "tiles");
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                write_image(file(column, row, extension, prefix),
                            cut(image, {32 * column, 20 * row, std::min(70, 32 * column + 32),
                                        std::min(50, 20 * row + 20)}));
    }
    std::string file(int column, int row, const std::string& extension, const std::string& prefix) const {
        return folder / ("tiles/" + prefix + cat(column, '_', row, extension));
    }
    std::string list(bool sizes, const std::string& extension) const {
        std::string text =
            R"({"format": "imgmesh-tile-list", "version": 1, "width": 70, "height": 50, "tiles": [)";
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column) {
                text += cat(row + column ? ", " : "", R"({"file": "tiles/t_)", column, '_', row, extension,
                            R"(", "x": )", 32 * column, R"(, "y": )", 20 * row);
                if (sizes)
                    text += cat(R"(, "width": )", column < 2 ? 32 : 6, R"(, "height": )", row < 2 ? 20 : 10);
                text += "}";
            }
        save_text(folder / "list.json", text + "]}");
        return folder / "list.json";
    }
};

}  // namespace

TEST_CASE("tile lists: JSON, with and without sizes, of files that are read by parts and as a whole") {
    for (const char* extension : {".png", ".bmp", ".tif"}) {
        const Tiles tiles(extension);
        for (const bool sizes : {false, true}) check_is(tiles.list(sizes, extension), tiles.image);
    }
}

TEST_CASE("tile lists: a missing or broken file is an error where it is read, and named") {
    const Tiles tiles(".png");
    for (const bool sizes : {false, true}) {
        const std::string list = tiles.list(sizes, ".png");
        std::filesystem::remove(tiles.file(1, 1, ".png", "t_"));
        save_text(tiles.file(2, 2, ".png", "t_"), "not a PNG");
        CHECK(failure(list, {0, 0, 70, 20}).empty());
        CHECK(failure(list, {0, 0, 32, 50}).empty());
        CHECK(names(failure(list, {30, 19, 33, 21}), "t_1_1.png"));
        CHECK(names(failure(list, {69, 49, 70, 50}), "t_2_2.png"));
    }
    // A file of another size than the list has it, and of other channels.
    const std::string list = tiles.list(true, ".png");
    write_image(tiles.file(1, 1, ".png", "t_"), busy(31, 20));
    CHECK(names(failure(list, {40, 25, 41, 26}), "expected 32x20"));
    write_image(tiles.file(1, 1, ".png", "t_"), busy(32, 20, 1));
    CHECK(names(failure(list, {40, 25, 41, 26}), "other channels"));
}

TEST_CASE("tile lists: later files lie over earlier ones") {
    const TemporaryFolder folder;
    const Image image = busy(40, 30);
    write_image(folder / "a.png", busy(21, 30));
    write_image(folder / "b.png", cut(image, {20, 0, 40, 30}));
    write_image(folder / "a.png", cut(image, {0, 0, 21, 30}));
    const auto list = [&](const char* tiles) {
        save_text(folder / "l.json",
                  cat(R"({"format": "imgmesh-tile-list", "version": 1, "tiles": [)", tiles, "]}"));
        return folder / "l.json";
    };
    check_is(list(R"({"file": "a.png", "x": 0, "y": 0}, {"file": "b.png", "x": 20, "y": 0})"), image);
    Image marked = cut(image, {0, 0, 21, 30});
    for (int c = 0; c < 3; ++c) marked.pixel(20, 7)[c] = 0;
    write_image(folder / "a.png", marked);
    check_is(list(R"({"file": "a.png", "x": 0, "y": 0}, {"file": "b.png", "x": 20, "y": 0})"), image);
    Image over = image;
    for (int c = 0; c < 3; ++c) over.pixel(20, 7)[c] = 0;
    check_is(list(R"({"file": "b.png", "x": 20, "y": 0}, {"file": "a.png", "x": 0, "y": 0})"), over);
}

TEST_CASE("tile lists: gaps and tiles outside of the picture are refused, and what is no list") {
    const Tiles tiles(".png");
    const auto list = [&](const std::string& tail, const std::string& text) {
        save_text(tiles.folder / "l.json", cat(R"({"format": "imgmesh-tile-list", "version": 1)", tail,
                                               R"(, "tiles": [)", text, "]}"));
        return failure(tiles.folder / "l.json");
    };
    const std::string a = R"({"file": "tiles/t_0_0.png", "x": 0, "y": 0})";
    CHECK(list("", a).empty());
    CHECK(names(list(R"(, "width": 40)", a), "no file has pixel (32, 0)"));
    CHECK(names(list(R"(, "height": 40)", a), "no file has pixel (0, 20)"));
    CHECK(names(list("", a + R"(, {"file": "tiles/t_1_0.png", "x": 33, "y": 0})"),
                "no file has pixel (32, 0)"));
    CHECK(names(list(R"(, "width": 30)", a), "not inside"));
    CHECK(names(list("", R"({"file": "none.png", "x": 0, "y": 0})"), "none of its files can be read"));
    CHECK(names(list("", R"({"file": "tiles/t_0_0.png", "x": -1, "y": 0})"), "/x"));
    CHECK(!list(R"(, "more": 1)", a).empty());
    CHECK(!list("", "").empty());
    save_text(tiles.folder / "l.json", "{}");
    CHECK(names(failure(tiles.folder / "l.json"), "imgmesh-tile-list"));
    save_text(tiles.folder / "l.json", R"({"format": "imgmesh-tile-list", "version": 2})");
    CHECK(names(failure(tiles.folder / "l.json"), "version 2"));
    save_text(tiles.folder / "l.json", std::string(100000, '['));
    CHECK(!failure(tiles.folder / "l.json").empty());
}

TEST_CASE("tile lists: a folder of files by column and row") {
    for (const char* prefix : {"", "t_", "slide-7_"}) {
        const Tiles tiles(".png", prefix);
        save_text(tiles.folder / "tiles/readme.txt", "not a tile");
        check_is(tiles.folder / "tiles", tiles.image);
        std::filesystem::remove(tiles.file(1, 1, ".png", prefix));
        CHECK(failure(tiles.folder / "tiles", {0, 0, 70, 20}).empty());
        CHECK(names(failure(tiles.folder / "tiles", {40, 25, 41, 26}), "1_1.png"));
        save(tiles.folder / "tiles/other_0_0.png", load(tiles.file(0, 0, ".png", prefix)));
        CHECK(names(failure(tiles.folder / "tiles"), "two pictures"));
    }
    const TemporaryFolder folder;
    CHECK(names(failure(folder.path().string()), "no files that are named by column and row"));
}

namespace {

std::string vrt(const std::string& sources, const std::string& head = "") {
    return cat("<VRTDataset rasterXSize=\"64\" rasterYSize=\"20\"", head, "><VRTRasterBand band=\"1\">",
               sources, "</VRTRasterBand></VRTDataset>");
}
std::string source(int column, const std::string& more = "", int width = 32) {
    return cat("<SimpleSource><SourceFilename relativeToVRT=\"1\">tiles/t_", column,
               "_0.png</SourceFilename><SourceBand>1</SourceBand><SrcRect xOff=\"0\" yOff=\"0\" xSize=\"32\" "
               "ySize=\"20\"/><DstRect xOff=\"",
               32 * column, "\" yOff=\"0\" xSize=\"", width, "\" ySize=\"20\"/>", more, "</SimpleSource>");
}

}  // namespace

TEST_CASE("tile lists: GDAL's VRT, if it puts files side by side") {
    const Tiles tiles(".png");
    const std::string path = tiles.folder / "m.vrt";
    save_text(path, vrt(source(0) + source(1)));
    check_is(path, cut(tiles.image, {0, 0, 64, 20}));
    // A part of a file.
    std::string part = vrt(source(0) + source(1));
    part.replace(part.find("xOff=\"0\" yOff=\"0\" xSize=\"32\" ySize=\"20\"/><DstRect xOff=\"32\""), 8,
                 "xOff=\"3\"");
    save_text(path, part);
    CHECK(names(failure(path, {40, 0, 41, 1}), "expected at least 35x20"));
    const auto refused = [&](const std::string& text) {
        save_text(path, text);
        return failure(path);
    };
    CHECK(names(refused(vrt(source(0, "", 16))), "another size than its place"));
    CHECK(names(refused(vrt(source(0, "<ScaleRatio>2</ScaleRatio>"))), "ScaleRatio"));
    CHECK(names(refused(vrt(source(0), " subClass=\"VRTWarpedDataset\"")), "VRTWarpedDataset"));
    CHECK(names(refused(vrt("<KernelFilteredSource/>")), "KernelFilteredSource"));
    CHECK(names(refused(vrt(source(0))), "no file has pixel (32, 0)"));
    CHECK(names(refused("<VRTDataset rasterXSize=\"1e9\" rasterYSize=\"20\"/>"), "rasterXSize"));
    CHECK(names(refused("<!DOCTYPE a [<!ENTITY b \"c\">]><VRTDataset>"), "not XML"));
    CHECK(names(refused("<a/>"), "VRTDataset"));
    CHECK(!refused(std::string(100000, '<')).empty());
}
