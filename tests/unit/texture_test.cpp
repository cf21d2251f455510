#include <doctest/doctest.h>

#include "libcore/base/error.h"
#include "libcore/image/color.h"
#include "libcore/image/texture_image.h"

using namespace imgmesh;

namespace {

// The mask of the middle pixel of `side` x `side`.
Mask middle(int side) {
    Mask mask{side, side, std::vector<std::uint8_t>(static_cast<std::size_t>(side * side))};
    mask.inside[mask.inside.size() / 2] = 1;
    return mask;
}

}  // namespace

TEST_CASE("texture: an 8-bit sRGB picture is itself, without its alpha") {
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

// Nothing that lies outside, here green, may mix in at the cut-out's edge.
TEST_CASE("texture: pixels outside of a cut-out are transparent and have the colours inside") {
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
    ends.inside.front() = ends.inside.back() = 1;
    wide.data.front() = wide.data.back() = 1;
    CHECK(Vec3f(texture_image(wide, ends).data.data() + 4 * 20) == Vec3f(0.5f, 0, 0.5f));
    CHECK(Vec3f(texture_image(wide, ends).data.data() + 4 * 8) == Vec3f(1, 0, 0));
}

TEST_CASE("texture: a picture without colour has none") {
    Image image = make_image(2, 2, 5);
    CHECK_THROWS_AS(texture_image(image, {}), Error);
}
