// Images as pictures of 8 bits, and coded pictures as meshes.
#include <doctest/doctest.h>

#include "libcore/coding/coded_mesh_image.h"
#include "libcore/coding/image_bitmap.h"
#include "libcore/image/color.h"

using namespace imgmesh;
using Codes = std::vector<std::uint8_t>;

namespace {

Image image_of(int channels, std::vector<float> samples) {
    Image image = make_image(static_cast<int>(samples.size()) / channels, 1, channels);
    image.data = std::move(samples);
    return image;
}

// A picture of 5 x 3 pixels as two faces, in one colour.
coding::StreamContent two_faces(int channels, const std::vector<int>& grey_levels) {
    coding::StreamContent content;
    content.grid = {5, 3, 8};
    content.channels = channels;
    content.point = {{0, 0}, {2, 0}, {0, 1}, {2, 1}};
    content.faces = {{0, 2, 1}, {1, 2, 3}};
    for (std::size_t v = 0; v < content.point.size(); ++v)
        for (const int level : grey_levels) content.color.push_back(level * coding::kColorUnit);
    return content;
}

}  // namespace

TEST_CASE("a picture has as few channels as its colours take") {
    CHECK(bitmap_from_image(image_of(3, {0.2f, 0.2f, 0.2f, 1, 1, 1})).channels == 1);
    CHECK(bitmap_from_image(image_of(3, {0.2f, 0.2f, 0.2f, 1, 1, 0})).channels == 3);
    CHECK(bitmap_from_image(image_of(4, {0.2f, 0, 0, 1, 1, 1, 1, 1})).channels == 3);
    CHECK(bitmap_from_image(image_of(4, {0.2f, 0, 0, 1, 1, 1, 1, 0})).channels == 4);
    CHECK(bitmap_from_image(image_of(4, {0.2f, 0.2f, 0.2f, 1, 1, 1, 1, 0.5f})).data ==
          Codes{51, 255, 255, 128});
    CHECK(bitmap_from_image(image_of(1, {0, 0.5f, 1})).data == Codes{0, 128, 255});
}

TEST_CASE("a picture is sRGB of 8 bits, clipped") {
    Image linear = image_of(3, {1.5f, -0.5f, 0.2158605f});  // the last is 128 in sRGB
    linear.color_space = ColorSpace::kLinear;
    linear.sample_type = SampleType::kFloat;
    CHECK(bitmap_from_image(linear).data == Codes{255, 0, 128});
}

TEST_CASE("an image of a picture gives the picture back") {
    for (int channels = 1; channels <= 4; ++channels) {
        Bitmap picture{64, 1, channels, {}};
        for (int i = 0; i < 64 * channels; ++i) picture.data.push_back(static_cast<std::uint8_t>(i * 37));
        const Image image = image_from_bitmap(picture);
        CHECK(image.channels == channels);
        CHECK((image.channel("A") >= 0) == picture.has_alpha());
        CHECK(bitmap_from_image(image).data == picture.data);
    }
}

TEST_CASE("the mesh of a coded picture lies on its pixels and has its colours") {
    const MeshImage m = coding::mesh_image_from_coded(two_faces(3, {255, 0, 51}));
    const Level& level = m.levels[0];
    CHECK(level.mesh.position == std::vector<Vec2f>{{0, 0}, {4, 0}, {0, 2}, {4, 2}});
    for (const PixelCoord& coord : level.map) CHECK(coord.face != kNone);
    const Vec3f luv(level.mesh.feature[0], level.mesh.feature[1], level.mesh.feature[2]);
    const Vec3f srgb = encoded_from_linear(ColorSpace::kSrgb, linear_from_luv(luv));
    CHECK((srgb - Vec3f(1, 0, 0.2f)).norm() < 1e-3f);
}

TEST_CASE("colours of a mesh are divided by alpha") {
    const MeshImage m = coding::mesh_image_from_coded(two_faces(2, {51, 102}));
    const BaseMesh& mesh = m.levels[0].mesh;
    CHECK(m.source.channel_names == std::vector<std::string>{"Y", "A"});
    CHECK(mesh.channels == 4);
    CHECK(mesh.feature[3] == doctest::Approx(0.4));
    const Vec3f luv(mesh.feature[0], mesh.feature[1], mesh.feature[2]);
    CHECK((encoded_from_linear(ColorSpace::kSrgb, linear_from_luv(luv)) - Vec3f(0.5f, 0.5f, 0.5f)).norm() <
          1e-3f);
}

TEST_CASE("vertices that are not seen have the colours of those beside them, however far") {
    coding::StreamContent content = two_faces(4, {0, 0, 0, 0});
    content.grid = {9, 3, 8};
    content.point = {{0, 0}, {1, 0}, {2, 0}, {4, 0}, {0, 1}, {1, 1}, {2, 1}, {4, 1}};
    content.faces = {{0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 6}, {2, 6, 3}, {3, 6, 7}};
    content.color.assign(8 * 4, 0);
    const auto paint = [&](std::size_t v, int red, int alpha) {
        content.color[4 * v] = red * coding::kColorUnit;
        content.color[4 * v + 3] = alpha * coding::kColorUnit;
    };
    const auto red_of = [&](Id v) {
        const MeshImage m = coding::mesh_image_from_coded(content);
        const float* f = m.levels[0].mesh.feature_of(v);
        return encoded_from_linear(ColorSpace::kSrgb, linear_from_luv(Vec3f(f[0], f[1], f[2]))).x();
    };
    CHECK(red_of(0) == doctest::Approx(0).epsilon(1e-3));  // nothing is seen at all
    paint(0, 200, 200);
    paint(4, 9, 2);  // clipped
    for (Id v = 0; v < 8; ++v) CHECK(red_of(v) == doctest::Approx(1).epsilon(1e-3));
    paint(4, 0, 100);  // a third of what is seen
    CHECK(red_of(1) == doctest::Approx(2.0 / 3).epsilon(1e-3));
    CHECK(red_of(5) == doctest::Approx(0).epsilon(1e-3));  // has the other neighbour only
    const MeshImage m = coding::mesh_image_from_coded(content);
    CHECK(m.levels[0].mesh.feature_of(7)[3] == 0);
}

TEST_CASE("a side of one pixel is a strip around it") {
    coding::StreamContent content = two_faces(1, {9});
    content.grid = {5, 1, 8};
    content.point = {{0, 0}, {2, 0}, {0, 1}, {2, 1}};
    const MeshImage m = coding::mesh_image_from_coded(content);
    CHECK(m.levels[0].mesh.position == std::vector<Vec2f>{{0, -0.5f}, {4, -0.5f}, {0, 0.5f}, {4, 0.5f}});
    for (const PixelCoord& coord : m.levels[0].map) CHECK(coord.face != kNone);
}
