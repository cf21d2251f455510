#include <doctest/doctest.h>

#include <cstdlib>
#include <random>

#include "libcore/base/error.h"
#include "libcore/image/color.h"
#include "libcore/image/texture_image.h"

using namespace imgmesh;

namespace {

// The mask of the middle pixel of `side` x `side`.
Mask middle(int side) {
    Mask mask{side, side, std::vector<std::uint8_t>(static_cast<std::size_t>(side * side))};
    mask[mask.size() / 2] = 1;
    return mask;
}

}  // namespace

TEST_CASE("texture: an 8-bit sRGB image is itself, without its alpha") {
    Image image = make_image(3, 2, 4);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i) / 255;
    const Image texture = texture_image(image, {});
    REQUIRE(texture.channel_names == std::vector<std::string>{"R", "G", "B"});
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t c = 0; c < 3; ++c) CHECK(texture.data[3 * i + c] == image.data[4 * i + c]);
}

TEST_CASE("texture: grey becomes colour, other spaces sRGB, light and shadow are clipped") {
    Image image = make_image(3, 1, 1);
    image.color_space = ColorSpace::kLinear;
    image.sample_type = SampleType::kFloat;
    image.data = {0.2140411f, 7.5f, -0.5f};  // the linear value of sRGB 0.5
    const Image texture = texture_image(image, {});
    CHECK(texture.color_space == ColorSpace::kSrgb);
    CHECK(texture.sample_type == SampleType::kUint8);
    const float expected[] = {0.5f, 1, 0};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            CHECK(texture.data[3 * i + c] == doctest::Approx(expected[i]).epsilon(1e-6));
}

// Colours outside, here green, must not mix in at the masked image's edge.
TEST_CASE("texture: pixels outside of a masked image are transparent and have the colours inside") {
    for (const int side : {1, 3, 41}) {
        Image image = make_image(side, side, 3);
        for (std::size_t i = 0; i < image.pixel_count(); ++i) image.data[3 * i + 1] = 1;
        const std::size_t centre = image.pixel_count() / 2;
        image.data[3 * centre] = 0.75f;
        image.data[3 * centre + 1] = 0.25f;
        const Image texture = texture_image(image, middle(side));
        REQUIRE(texture.channels == 4);
        for (std::size_t i = 0; i < image.pixel_count(); ++i) {
            CHECK(Vec3f(texture.data.data() + 4 * i) == Vec3f(0.75f, 0.25f, 0));
            CHECK(texture.data[4 * i + 3] == (i == centre ? 1 : 0));
        }
    }
}

// By hand: red | outside | outside | blue, in one row. Each gap takes its only coloured neighbour in the
// first ring.
TEST_CASE("texture: colours spread ring by ring, and the rest has their mean") {
    Image image = make_image(4, 1, 3);
    image.data = {1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1};
    const Image texture = texture_image(image, {4, 1, {1, 0, 0, 1}});
    CHECK(Vec3f(texture.data.data() + 4) == Vec3f(1, 0, 0));
    CHECK(Vec3f(texture.data.data() + 8) == Vec3f(0, 0, 1));
    Image wide = make_image(40, 1, 3);
    Mask ends{40, 1, std::vector<std::uint8_t>(40)};
    ends.values.front() = ends.values.back() = 1;
    wide.data.front() = wide.data.back() = 1;
    CHECK(Vec3f(texture_image(wide, ends).data.data() + 4 * 20) == Vec3f(0.5f, 0, 0.5f));
    CHECK(Vec3f(texture_image(wide, ends).data.data() + 4 * 8) == Vec3f(1, 0, 0));
}

// The definition, pixel by pixel over the whole image for each ring.
TEST_CASE("texture: colours spread as they are said to, out of masks of any shape") {
    std::mt19937 random(4);
    for (const int share : {2, 30, 400}) {
        const int width = 37, height = 29;
        Image image = make_image(width, height, 3);
        Mask mask{width, height, {}};
        for (std::size_t i = 0; i < image.pixel_count(); ++i)
            mask.values.push_back(random() % static_cast<unsigned>(share) == 0);
        mask[5] = 1;
        for (float& v : image.data) v = static_cast<float>(random() % 256) / 255;
        std::vector<Vec3f> color(image.pixel_count());
        std::vector<std::uint8_t> colored = mask.values;
        Vec3d sum(0, 0, 0);
        for (std::size_t i = 0; i < color.size(); ++i) {
            color[i] = Vec3f(image.data.data() + 3 * i);
            if (mask[i]) sum += color[i].cast<double>();
        }
        for (int ring = 0; ring < 8; ++ring) {
            const std::vector<std::uint8_t> before = colored;
            for (int i = 0; i < width * height; ++i) {
                Vec3f near(0, 0, 0);
                float count = 0;
                for (int j = 0; j < width * height; ++j) {
                    if (!before[static_cast<std::size_t>(j)] || std::abs(i % width - j % width) > 1 ||
                        std::abs(i / width - j / width) > 1)
                        continue;
                    near += color[static_cast<std::size_t>(j)];
                    ++count;
                }
                if (before[static_cast<std::size_t>(i)] || count == 0) continue;
                color[static_cast<std::size_t>(i)] = near / count;
                colored[static_cast<std::size_t>(i)] = 1;
            }
        }
        const Image texture = texture_image(image, mask);
        for (std::size_t i = 0; i < color.size(); ++i) {
            const Vec3f want = colored[i] ? color[i] : Vec3f((sum / double(mask.count())).cast<float>());
            CHECK(Vec3f(texture.data.data() + 4 * i) == want);
        }
    }
}

TEST_CASE("texture: an image without colour has none") {
    Image image = make_image(2, 2, 5);
    CHECK_THROWS_AS(texture_image(image, {}), Error);
}

TEST_CASE("texture: an alpha of its own is kept inside the mask, clipped") {
    Image image = make_image(3, 1, 4);
    image.data = {1, 0, 0, 0.25f, 0, 1, 0, 1.5f, 0, 0, 1, 0.75f};
    const Image whole = texture_image(image, {}, TextureAlpha::kOwn);
    REQUIRE(whole.channels == 4);
    CHECK(whole.data[3] == 0.25f);
    CHECK(whole.data[7] == 1);
    const Image cut = texture_image(image, {3, 1, {1, 1, 0}}, TextureAlpha::kOwn);
    CHECK(cut.data[3] == 0.25f);
    CHECK(cut.data[11] == 0);
    CHECK(texture_image(make_image(2, 2, 3), {}, TextureAlpha::kOwn).channels == 3);
}
