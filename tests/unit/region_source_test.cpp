// Parts of a picture are what the whole picture has there.
#include <doctest/doctest.h>

#include "formats/picture/region_source.h"
#include "libcore/base/error.h"
#include "tests/support/region_checks.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

// No two pixels are alike, and no sample is that of another channel.
Image slope(int width, int height, int channels) {
    Image image = make_image(width, height, channels);
    for (std::size_t i = 0; i < image.data.size(); ++i)
        image.data[i] = static_cast<float>((i * 37) % 256) / 255.0f;
    return image;
}

bool throws(ErrorKind kind, const auto& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.kind() == kind;
    }
    return false;
}

}  // namespace

TEST_CASE("regions: a picture that is held as a whole") {
    const TemporaryFolder folder;
    for (const char* name : {"a.bmp", "a.webp"}) {
        write_image(folder / name, slope(37, 21, 3));
        check_regions(folder / name, 10);
    }
}

TEST_CASE("regions: what is not inside the picture is refused") {
    const TemporaryFolder folder;
    write_image(folder / "a.bmp", slope(37, 21, 3));
    const RegionSource source(folder / "a.bmp");
    for (const PixelRect& r : {PixelRect{-1, 0, 3, 3}, PixelRect{0, -1, 3, 3}, PixelRect{0, 0, 38, 3},
                               PixelRect{0, 0, 3, 22}, PixelRect{3, 0, 3, 3}, PixelRect{0, 5, 3, 4}})
        CHECK(throws(ErrorKind::kBadArgument, [&] { (void)source.read(r); }));
    CHECK(throws(ErrorKind::kBadArgument,
                 [&] { const RegionSource other(folder / "a.bmp", {.non_finite = NonFinite::kNearest}); }));
}

TEST_CASE("regions: Netpbm's files of bytes, whose rows have places") {
    const TemporaryFolder folder;
    const std::string path = folder / "a.pnm";
    constexpr int kWidth = 77, kHeight = 41;
    struct Kind {
        std::string header;
        int row_bytes;
        bool floats = false;
    };
    const Kind kinds[] = {
        {"P4 77 # of bits\n41\n", 10},
        {"P5\n# two lines\n77 41\n200\n", kWidth},
        {"P5 77 41# close\n1000\n", 2 * kWidth},
        {"P6\n77 41 255\n", 3 * kWidth},
        {"P6\n77 41 65535\n", 6 * kWidth},
        {"PF\n77 41\n-2.5\n", 12 * kWidth, true},
        {"Pf 77 41 1\n", 4 * kWidth, true},
        {"P7\nHEIGHT 41\nWIDTH 77\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n", 4 * kWidth},
        {"P7\nWIDTH 77\nHEIGHT 41\n# more\nDEPTH 6\nMAXVAL 900\nTUPLTYPE RGB\nENDHDR\n", 12 * kWidth}};
    std::mt19937 random(3);
    for (const Kind& kind : kinds) {
        INFO(kind.header);
        std::vector<std::uint8_t> bytes(kind.header.begin(), kind.header.end());
        for (int i = 0; i < kind.row_bytes * kHeight; ++i)
            bytes.push_back(static_cast<std::uint8_t>(kind.floats ? random() % 64 : random()));
        save(path, bytes);
        CHECK(RegionSource(path).facts().access == RegionAccess::kDirect);
        check_regions(path, 19);
        check_random_regions(path, 10);
        check_random_regions(path, 5, {.values = true, .nodata = 3});
        // What is not there is an error where it is read.
        const ReadImage whole = read_image_file(path);
        bytes.resize(bytes.size() - static_cast<std::size_t>(kind.row_bytes));
        save(path, bytes);
        const RegionSource cut(path);
        const bool up = kind.floats;
        const PixelRect there{0, up ? 1 : 0, kWidth, up ? kHeight : kHeight - 1},
            gone{5, up ? 0 : kHeight - 1, 6, up ? 1 : kHeight};
        check_part(cut.read_region(there), whole, there);
        CHECK(throws(ErrorKind::kBadFile, [&] { (void)cut.read(gone); }));
    }
    for (const std::string header :
         {"P5 0 3 255 ", "P6 999999 999999 255\n", "P6 4 4 70000 ", "P6 4 4", "P7\nDEPTH 999999\nENDHDR\n"}) {
        INFO(header);
        save(path, {header.begin(), header.end()});
        CHECK(throws(ErrorKind::kBadFile, [&] { const RegionSource source(path); }));
    }
    const std::string text = "P2 2 2 9 1 2 3 4";
    save(path, {text.begin(), text.end()});
    CHECK(RegionSource(path).facts().access == RegionAccess::kWhole);
    check_regions(path, 1);
}
