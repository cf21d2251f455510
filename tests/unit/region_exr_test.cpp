// Regions of EXR files: of the chunks of lines or the tiles that they touch, and what the whole image has
// there.
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "formats/picture/region_source.h"
#include "formats/picture/spool.h"
#include "libcore/base/error.h"
#include "tests/support/exr_files.h"
#include "tests/support/region_checks.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

using Change = std::function<void(Imf::Header&)>;

constexpr int kWidth = 83, kHeight = 71;

std::vector<float> noise(unsigned seed, std::size_t count = std::size_t{kWidth} * kHeight) {
    std::mt19937 random(seed);
    std::vector<float> out(count);
    for (float& value : out) value = static_cast<float>(random() % 4096) / 512;
    return out;
}

std::vector<ExrPlane> colors(Imf::PixelType type) {
    return {{"R", 0, type, noise(1)}, {"G", 0, type, noise(2)}, {"B", 0, type, noise(3)}};
}

Change tiles(unsigned width, unsigned height, Imf::LevelMode mode = Imf::ONE_LEVEL) {
    return [=](Imf::Header& header) { header.setTileDescription({width, height, mode}); };
}
Change both(const Change& a, const Change& b) {
    return [=](Imf::Header& header) {
        a(header);
        b(header);
    };
}
Change packed(Imf::Compression compression) {
    return [=](Imf::Header& header) { header.compression() = compression; };
}

void write(const std::string& path, const std::vector<ExrPlane>& planes, const Change& change) {
    write_exr_file(path, {{"", planes, change}}, kWidth, kHeight);
}

// By parts, from a file that is read in place.
void check(const std::string& path, const ReadImageOptions& options = {}) {
    CHECK(RegionSource(path, options).facts().access == RegionAccess::kDirect);
    check_regions(path, 29, options);
    check_random_regions(path, 12, options);
}

// Where the table of chunks is: its first entry leads to what follows it.
std::size_t table_at(const std::vector<std::uint8_t>& bytes, std::size_t count) {
    for (std::size_t at = 8; at + 8 <= bytes.size(); ++at) {
        std::uint64_t entry = 0;
        std::memcpy(&entry, &bytes[at], 8);
        if (entry == at + 8 * count) return at;
    }
    FAIL("no table");
    return 0;
}
std::uint64_t entry_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    std::uint64_t entry = 0;
    std::memcpy(&entry, &bytes[at], 8);
    return entry;
}

std::int64_t peak_memory() {
    rusage use = {};
    getrusage(RUSAGE_SELF, &use);
    return std::int64_t{use.ru_maxrss} << 10;
}

}  // namespace

TEST_CASE("exr regions: every compression, lines and tiles, halves and floats") {
    const TemporaryFolder folder;
    const std::string path = folder / "c.exr";
    for (int c = 0; c < Imf::NUM_COMPRESSION_METHODS; ++c)
        for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
            INFO("compression ", c, ", type ", int{type});
            const Change how = packed(static_cast<Imf::Compression>(c));
            write(path, colors(type), how);
            check(path);
            write(path, colors(type), both(how, tiles(32, 16)));
            check(path);
        }
}

TEST_CASE("exr regions: levels, orders of lines, tiles above the picture's size") {
    const TemporaryFolder folder;
    const std::string path = folder / "l.exr";
    for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS})
        for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y, Imf::RANDOM_Y}) {
            const Change ordered = [=](Imf::Header& header) { header.lineOrder() = order; };
            for (const unsigned size : {16u, 100u}) {
                write(path, colors(Imf::HALF), both(tiles(size, size + 7, mode), ordered));
                check(path);
            }
            if (order == Imf::RANDOM_Y) continue;  // of tiles alone
            write(path, colors(Imf::HALF), ordered);
            check(path);
        }
}

TEST_CASE("exr regions: data windows beside, inside and beyond the display window") {
    const TemporaryFolder folder;
    const std::string path = folder / "w.exr";
    for (const Imath::V2i& at : {Imath::V2i(0, 0), Imath::V2i(-20, -9), Imath::V2i(30, 40)})
        for (const Imath::Box2i& shown :
             {Imath::Box2i({0, 0}, {kWidth - 1, kHeight - 1}), Imath::Box2i({-40, -30}, {140, 150}),
              Imath::Box2i({5, 6}, {50, 44})})
            for (const bool tiled : {false, true}) {
                const Change windows = [=](Imf::Header& header) {
                    header.displayWindow() = shown;
                    header.dataWindow() = {at, at + Imath::V2i(kWidth - 1, kHeight - 1)};
                    if (tiled) header.setTileDescription({16, 24});
                };
                std::vector<ExrPlane> planes = colors(Imf::HALF);
                planes.push_back({"A", 0.5f});
                write(path, planes, windows);
                check(path);
            }
    // Nothing of the data is shown.
    write(path, colors(Imf::HALF), [](Imf::Header& header) {
        header.displayWindow() = {{1000, 1000}, {1020, 1010}};
    });
    check(path);
}

TEST_CASE("exr regions: parts, layers, alpha, other channels, integers, grey, primaries") {
    const TemporaryFolder folder;
    const std::string path = folder / "p.exr";
    std::vector<ExrPlane> layers;
    for (const std::string prefix : {"a.", "b."})
        for (ExrPlane plane : colors(Imf::FLOAT)) {
            plane.name = prefix + plane.name;
            plane.values = noise(static_cast<unsigned>(layers.size()) + 20);
            layers.push_back(plane);
        }
    layers.push_back({"b.A", 0, Imf::HALF, noise(40)});
    layers.push_back({"id", 0, Imf::UINT, {}, 1, (1u << 24) - 1});
    for (const Change& form : {Change([](Imf::Header&) {}), tiles(16, 32)}) {
        write_exr_file(path,
                       {{"depth", {{"Z", 1, Imf::FLOAT, noise(9)}}, form},
                        {"beauty", layers, form},
                        {"other", colors(Imf::HALF), tiles(32, 32)}},
                       kWidth, kHeight);
        check(path);
        check(path, {.layer = "b"});
        check(path, {.layer = "b", .channels = std::vector<std::string>{"R", "G", "B"}});
        check(path, {.part = "other"});
        check(path, {.part = "depth", .channels = std::vector<std::string>{"Z"}});
        check(path, {.layer = "b", .values = true});
        check(path, {.non_finite = NonFinite::kZero, .nodata = 1});
    }
    write(path, {{"Y", 0, Imf::HALF, noise(5)}}, tiles(20, 20));
    check(path);
    write(path, colors(Imf::FLOAT), [](Imf::Header& header) {
        Imf::addChromaticities(header,
                               {{0.713f, 0.293f}, {0.165f, 0.830f}, {0.128f, 0.044f}, {0.32168f, 0.33767f}});
    });
    check(path);
    check(path, {.color_space = ColorSpace::kSrgb});
}

TEST_CASE("exr regions: luminance and chroma, whose filters reach beyond the region") {
    const TemporaryFolder folder;
    const std::string path = folder / "y.exr";
    for (const auto& [width, height] : {std::pair(2, 2), std::pair(38, 44), std::pair(60, 90)}) {
        const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        const std::vector<ExrPlane> planes = {{"Y", 0, Imf::HALF, noise(1, count)},
                                              {"RY", 0, Imf::HALF, noise(2, count / 4), 2},
                                              {"BY", 0, Imf::HALF, noise(3, count / 4), 2},
                                              {"A", 0, Imf::HALF, noise(4, count)}};
        const Imath::Box2i window({-4, 6}, {width - 5, height + 5});
        write_exr_file(
            path,
            {{"", planes,
              [=](Imf::Header& header) { header.dataWindow() = header.displayWindow() = window; }}},
            width, height);
        check(path);
        check_regions(path, 1 + width / 6);
    }
}

TEST_CASE("exr regions: a broken or missing block is an error where it is read, and named") {
    const TemporaryFolder folder;
    const std::string path = folder / "b.exr";
    struct Form {
        Change change;
        std::size_t blocks, broken;
        PixelRect touches;
        std::vector<PixelRect> others;
    };
    const Form forms[] = {
        {packed(Imf::ZIP_COMPRESSION), 5, 2, {9, 40, 20, 41}, {{0, 0, 83, 32}, {0, 48, 83, 71}}},
        {both(packed(Imf::ZIP_COMPRESSION), tiles(32, 32)),
         9,
         4,
         {60, 40, 80, 60},
         {{0, 0, 83, 32}, {0, 64, 83, 71}, {0, 0, 32, 71}, {64, 0, 83, 71}}}};
    for (const Form& form : forms) {
        write(path, colors(Imf::HALF), form.change);
        const std::vector<std::uint8_t> good = load(path);
        const std::size_t table = table_at(good, form.blocks);
        const std::uint64_t block = entry_at(good, table + 8 * form.broken);
        for (const char* harm : {"bits", "place", "missing", "wrong place", "far", "cut"}) {
            std::vector<std::uint8_t> bytes = good;
            const auto put = [&](std::uint64_t entry) {
                std::memcpy(&bytes[table + 8 * form.broken], &entry, 8);
            };
            const std::string what = harm;
            INFO(what);
            if (what == "bits")
                for (std::size_t i = 0; i < 12; ++i) bytes[block + 40 + i] ^= 0xFF;
            if (what == "place") bytes[block] ^= 0x08;  // the block says where it belongs
            if (what == "missing") put(0);
            if (what == "wrong place") put(entry_at(good, table));
            if (what == "far") put(std::uint64_t{1} << 61);
            if (what == "cut") put(good.size() - 20);
            save(path, bytes);
            const RegionSource source(path);
            const std::string text = failure(source, form.touches);
            CHECK_MESSAGE((text.find(cat("columns ", form.touches.left, " to ")) != std::string::npos), text);
            CHECK(text.find('\n') == std::string::npos);
            for (const PixelRect& other : form.others) CHECK(failure(source, other).empty());
            // Of chunks of lines that follow each other OpenEXR asks for no places.
            if (what == "bits" || what == "place" || what == "missing")
                CHECK_THROWS_AS(read_image(path), Error);
        }
    }
}

TEST_CASE("exr regions: headers of any length, and what is refused before memory is taken") {
    const TemporaryFolder folder;
    const std::string path = folder / "h.exr";
    write(path, colors(Imf::HALF), [](Imf::Header& header) {
        header.insert("story", Imf::StringAttribute(std::string(300000, 's')));
    });
    check(path);

    write(path, colors(Imf::HALF), tiles(16, 16));
    const std::vector<std::uint8_t> good = load(path);
    const std::int64_t before = peak_memory();
    const auto refused = [&](const std::vector<std::uint8_t>& bytes, const std::string& word,
                             const ReadImageOptions& options = {}) {
        save(path, bytes);
        std::string text;
        try {
            const RegionSource source(path, options);
            text = failure(source, {0, 0, 8, 8});
        } catch (const Error& error) {
            CHECK(error.kind() == ErrorKind::kBadFile);
            text = error.what();
        }
        CHECK_MESSAGE((text.find(word) != std::string::npos), text);
        CHECK(text.find('\n') == std::string::npos);
    };
    // Both windows, or the size of the tiles.
    const auto with = [&](const char* name, std::size_t skipped, int x, int y) {
        std::vector<std::uint8_t> bytes = good;
        const std::string word(name);
        const auto at = std::search(bytes.begin(), bytes.end(), word.begin(), word.end());
        REQUIRE(at != bytes.end());
        const std::int32_t numbers[] = {x, y};
        std::memcpy(&*at + static_cast<std::ptrdiff_t>(word.size() + 1 + skipped), numbers, 8);
        return bytes;
    };
    constexpr std::size_t kBox = 6 + 4 + 8, kTiles = 9 + 4;  // the type, the size, the first corner
    constexpr int kLarge = 1 << 29;
    ReadImageOptions any;
    any.limits.max_pixels_per_byte = 0;
    refused(with("dataWindow", kBox, kLarge, kLarge), "");
    refused(with("dataWindow", kBox, 2000000, 70), "");
    refused(with("displayWindow", kBox, kLarge, 70), "pixels a side", any);
    refused(with("displayWindow", kBox, 999999, 999999), "pixels are read");
    refused(with("tiles", kTiles, kLarge, kLarge), "");
    refused(with("tiles", kTiles, 60000, 60000), "", any);
    for (std::size_t size = 0; size < good.size(); size += 97) {
        INFO("cut to ", size);
        save(path, {good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)});
        try {
            const RegionSource source(path);
            CHECK((size > good.size() / 4 || !failure(source, {0, 0, kWidth, kHeight}).empty()));
        } catch (const Error& error) {
            CHECK(error.kind() == ErrorKind::kBadFile);
        }
    }
    CHECK(peak_memory() - before < std::int64_t{64} << 20);
}

TEST_CASE("regions: a sweep covers each pixel once, and passes broken blocks over") {
    const TemporaryFolder folder;
    const std::string path = folder / "s.exr";
    for (const bool tiled : {false, true}) {
        write(path, colors(Imf::HALF),
              both(packed(Imf::ZIP_COMPRESSION), tiled ? tiles(16, 16) : Change([](Imf::Header&) {})));
        const std::size_t blocks = tiled ? 30 : 5, broken = tiled ? 8 : 1;  // at (32, 16), or row 16
        std::vector<std::uint8_t> bytes = load(path);
        const std::uint64_t block = entry_at(bytes, table_at(bytes, blocks) + 8 * broken);
        for (std::size_t i = 0; i < 12; ++i) bytes[block + 40 + i] ^= 0xFF;
        save(path, bytes);
        for (const std::int64_t most : {std::int64_t{1} << 28, std::int64_t{700}}) {
            ReadImageOptions options;
            options.limits.max_pixels = most;
            const RegionSource source(path, options);
            std::vector<int> seen(std::size_t{kWidth} * kHeight);
            source.sweep([&](const PixelRect& part) {
                (void)source.read(part);
                for (int y = part.top; y < part.bottom; ++y)
                    for (int x = part.left; x < part.right; ++x)
                        ++seen[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)];
                return true;
            });
            CHECK(std::ranges::max(seen) == 1);
            // A block does not begin where a half does, so up to two of its size are lost beside it.
            const auto lost = std::ranges::count(seen, 0);
            CHECK(lost >= (tiled ? 16 * 16 : 16 * kWidth));
            CHECK(lost <= (tiled ? 4 * 16 * 16 : 2 * 16 * kWidth));
            int calls = 0;
            source.sweep([&](const PixelRect&) { return ++calls == 0; });
            CHECK(calls == 1);
        }
    }
}

TEST_CASE("spool exr: lines become tiles of which parts are what the picture has") {
    const TemporaryFolder folder;
    const std::string path = folder / "s.exr", copy = folder / "c";
    constexpr int kWide = 300, kHigh = 290;  // more than a tile each way
    constexpr std::size_t kCount = std::size_t{kWide} * kHigh;
    const std::vector<ExrPlane> planes = {{"R", 0, Imf::HALF, noise(1, kCount)},
                                          {"G", 0, Imf::FLOAT, noise(2, kCount)},
                                          {"B", 0, Imf::HALF, noise(3, kCount)},
                                          {"A", 0, Imf::HALF, noise(4, kCount)},
                                          {"id", 0, Imf::UINT, {}, 1, 77},
                                          {"l.R", 1},
                                          {"l.G", 2},
                                          {"l.B", 0, Imf::HALF, noise(5, kCount)}};
    const auto windows = [](Imf::Header& header) {
        header.dataWindow() = {{-7, 20}, {kWide - 8, kHigh + 19}};
        header.displayWindow() = {{0, 0}, {kWide + 20, kHigh}};
        header.compression() = Imf::PIZ_COMPRESSION;
        Imf::addChromaticities(header, {});
        header.insert("story", Imf::StringAttribute("long"));
    };
    const auto check_spooled = [&](const ReadImageOptions& options) {
        spool_picture(path, copy, options);
        check_copy(path, copy, 170, options);
        CHECK(read_image_file(copy, options).metadata.size() ==
              read_image_file(path, options).metadata.size());
    };
    write_exr_file(path, {{"", planes, windows}}, kWide, kHigh);
    check_spooled({});
    check_spooled({.channels = std::vector<std::string>{"R", "id"}});
    check_spooled({.layer = "l", .channels = std::vector<std::string>()});
    write_exr_file(
        path, {{"depth", {{"Z", 1, Imf::FLOAT, noise(9, kCount)}}, windows}, {"beauty", planes, windows}},
        kWide, kHigh);
    check_spooled({});
    check_spooled({.part = "1"});
    check_spooled({.part = "depth", .channels = std::vector<std::string>{"Z"}});
    // Of tiles and of chroma there is none.
    write(path, colors(Imf::HALF), tiles(16, 16));
    CHECK_THROWS_AS(spool_picture(path, copy), Error);
}

TEST_CASE("spool exr: broken lines are missing tiles, and wide packed lines are rewritten") {
    const TemporaryFolder folder;
    const std::string path = folder / "s.exr", copy = folder / "c";
    constexpr std::size_t kHigh = 600;
    const auto flat = [](Imf::Compression compression) {
        return std::vector<ExrPart>{{"", exr_colors("", 0.5f, 0.25f, 0.125f), packed(compression)}};
    };
    write_exr_file(path, flat(Imf::ZIP_COMPRESSION), 64, kHigh);
    std::vector<std::uint8_t> bytes = load(path);
    const std::uint64_t block = entry_at(bytes, table_at(bytes, 38) + 8 * 20);  // lines 320 to 335
    for (std::size_t i = 0; i < 6; ++i) bytes[block + 12 + i] ^= 0xFF;
    save(path, bytes);
    const std::vector<std::string> warnings = spool_picture(path, copy);
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("not all of it can be read") == 0);
    const RegionSource source(copy);
    CHECK(failure(source, {0, 0, 64, 256}).empty());
    CHECK(failure(source, {0, 512, 64, 600}).empty());
    CHECK(!failure(source, {9, 400, 20, 420}).empty());

    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::ZIP_COMPRESSION})
        for (const int width : {4096, 4097}) {
            write_exr_file(path, flat(compression), width, 3);
            const bool waste = width > 4096 && compression != Imf::NO_COMPRESSION;
            const RegionSource wide(path);
            CHECK(wide.facts().access == (waste ? RegionAccess::kSpool : RegionAccess::kDirect));
            CHECK(!wide.facts().holds_all);
            CHECK(wide.read({4000, 2, 4001, 3}).data == std::vector<float>{0.5f, 0.25f, 0.125f});
        }
}
