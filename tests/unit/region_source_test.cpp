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
