// A TIFF written block by block is the picture that the blocks make.
#include "formats/picture/tiled_tiff.h"

#include <doctest/doctest.h>

#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

Image picture(int width, int height, int channels, ColorSpace space) {
    Image image = make_image(width, height, channels);
    image.color_space = space;
    for (std::size_t i = 0; i < image.data.size(); ++i)
        image.data[i] = static_cast<float>(i * 7919 % 256) / 255.0f;
    return image;
}

Image block_of(const Image& image, int left, int top, int right, int bottom) {
    Image out = make_image(right - left, bottom - top, image.channels);
    out.color_space = image.color_space;
    for (int y = top; y < bottom; ++y)
        for (int x = left; x < right; ++x)
            std::copy_n(image.pixel(x, y), image.channels, out.pixel(x - left, y - top));
    return out;
}

}  // namespace

TEST_CASE("TiledTiff: blocks of any size become one picture") {
    const TemporaryFolder folder;
    const std::string path = folder / "a.tif";
    for (const int channels : {1, 2, 3, 4})
        for (const SampleType type : {SampleType::kUint8, SampleType::kUint16}) {
            const ColorSpace space = channels < 3 ? ColorSpace::kSrgb : ColorSpace::kDisplayP3;
            const Image image = picture(600, 530, channels, space);
            PictureShape shape{{600, 530}, channels, SampleType::kUint8, space};
            {
                TiledTiff tiff(path, shape, type, true);
                for (int y = 0; y < 530; y += 200) {
                    for (int x = 0; x < 600; x += 250)
                        tiff.put(x, y, block_of(image, x, y, std::min(600, x + 250), std::min(530, y + 200)));
                    tiff.complete(std::min(530, y + 200));
                }
                tiff.commit();
            }
            const Image again = read_image(path);
            CHECK(again.width == 600);
            CHECK(again.channel_names == image.channel_names);
            CHECK(again.sample_type == type);
            CHECK(again.color_space == space);
            CHECK((again.data == image.data));
        }
    CHECK(folder.count() == 1);
}

TEST_CASE("TiledTiff: pixels that are never put are 0, and no file is left without commit") {
    const TemporaryFolder folder;
    {
        TiledTiff tiff(folder / "a.tif", {{300, 300}, 4}, {}, true);
        tiff.complete(300);
        tiff.commit();
        TiledTiff other(folder / "b.tif", {{300, 300}, 3}, {}, true);
        other.complete(300);
    }
    CHECK(folder.count() == 1);
    const Image image = read_image(folder / "a.tif");
    CHECK(std::ranges::all_of(image.data, [](float x) { return x == 0; }));
    CHECK_THROWS_AS(TiledTiff(folder / "a.tif", {{300, 300}, 3}, {}, false), Error);
    CHECK_THROWS_AS(TiledTiff(folder / "c.tif", {{300, 300}, 3}, SampleType::kHalf, true), Error);
}
