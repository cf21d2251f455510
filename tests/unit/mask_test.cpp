// Which pixels an image's alpha, or a mask's image, leaves inside.
#include <doctest/doctest.h>

#include "libcore/base/error.h"
#include "libcore/image/mask.h"
#include "libcore/image/mask_value.h"

using namespace imgmesh;

namespace {

using Inside = std::vector<std::uint8_t>;

// Three pixels side by side.
Image row_of(int channels, const std::vector<float>& samples) {
    Image image = make_image(3, 1, channels);
    image.data = samples;
    return image;
}

}  // namespace

TEST_CASE("masks: alpha from the threshold on") {
    const Image image = row_of(2, {0.9f, 0.49f, 0.1f, 0.5f, 0.2f, 1.0f});
    CHECK(alpha_mask(image, 0.5f).values == Inside{0, 1, 1});
    CHECK(alpha_mask(image, 0.75f).values == Inside{0, 0, 1});
    CHECK(alpha_mask(image, 0.5f).count() == 2);
    CHECK(alpha_mask(image, 0.4f).empty());                                   // all are inside
    CHECK(alpha_mask(row_of(3, {0, 0, 0, 0, 0, 0, 0, 0, 0}), 0.5f).empty());  // no alpha
}

TEST_CASE("masks: a mask's image counts by its alpha, else by its light") {
    CHECK(image_mask(row_of(1, {0, 0.5f, 1}), 0.5f).values == Inside{0, 1, 1});
    CHECK(image_mask(row_of(3, {0, 0, 0, 0.6f, 0.6f, 0.2f, 1, 0.5f, 0}), 0.5f).values == Inside{0, 0, 1});
    // An alpha that shows something, and one that is opaque.
    CHECK(image_mask(row_of(2, {1, 0, 0, 1, 1, 1}), 0.5f).values == Inside{0, 1, 1});
    CHECK(image_mask(row_of(2, {1, 1, 0, 1, 1, 1}), 0.5f).values == Inside{1, 0, 1});
    Image alpha = row_of(1, {1, 1, 1});
    alpha.channel_names = {"A"};
    CHECK(image_mask(alpha, 0.5f).values == Inside{1, 1, 1});
    alpha.channel_names = {"Z"};
    CHECK_THROWS_AS(image_mask(alpha, 0.5f), Error);
}

TEST_CASE("masks: the largest value is that of the channel that counts") {
    CHECK(largest_mask_value(row_of(1, {0, 0.25f, 0.1f}), 0.5f) == 0.25f);
    CHECK(largest_mask_value(row_of(3, {0, 0, 0, 0.25f, 0.5f, 0, 0.1f, 0, 0}), 0.5f) == 0.25f);
    CHECK(largest_mask_value(row_of(2, {1, 0, 1, 0.125f, 1, 0}), 0.5f) == 0.125f);  // alpha
    CHECK(largest_mask_value(row_of(2, {0, 1, 0.25f, 1, 0, 1}), 0.5f) == 0.25f);    // of opaque pixels
}

TEST_CASE("masks: nothing is inside beyond the image") {
    const Mask mask{2, 1, {1, 0}};
    CHECK(mask.at(0, 0));
    CHECK_FALSE(mask.at(1, 0));
    for (const auto& [x, y] : {std::pair{-1, 0}, {2, 0}, {0, 1}, {0, -1}}) CHECK_FALSE(mask.at(x, y));
    CHECK(Mask{}.contains(7));
}

// 2000 visible pixels: two soft ones are a thousandth, three are more.
TEST_CASE("has_soft_alpha: more than a thousandth of what is visible, or nothing opaque") {
    Image image = make_image(50, 50, 4);
    CHECK_FALSE(has_soft_alpha(image));  // nothing is visible
    for (std::size_t i = 0; i < 2000; ++i) image.pixel(i)[3] = i % 2 == 0 ? 1.0f : 254.0f / 255;
    for (std::size_t i = 2000; i < 2500; ++i) image.pixel(i)[3] = i % 2 == 0 ? 0.0f : 0.4f / 255;
    CHECK_FALSE(has_soft_alpha(image));
    image.pixel(std::size_t{0})[3] = image.pixel(std::size_t{1})[3] = 0.5f;
    CHECK_FALSE(has_soft_alpha(image));
    image.pixel(std::size_t{2})[3] = 2.0f / 255;
    CHECK(has_soft_alpha(image));
    for (std::size_t i = 0; i < 2500; ++i) image.pixel(i)[3] = i == 7 ? 1.0f / 255 : 0.0f;
    CHECK(has_soft_alpha(image));  // faint, and all that there is
    image.pixel(std::size_t{7})[3] = 1;
    CHECK_FALSE(has_soft_alpha(image));
    CHECK_FALSE(has_soft_alpha(make_image(3, 3, 3)));
}

TEST_CASE("least_visible_alpha: specks around what is seen are left out, faint borders and images stay") {
    const auto threshold_of = [](auto&& alpha_at) {
        Image image = make_image(40, 40, 4);
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x) image.pixel(x, y)[3] = static_cast<float>(alpha_at(x, y)) / 255;
        return least_visible_alpha(image);
    };
    const auto in_square = [](int x, int y, int from) {
        return x >= from && x < 40 - from && y >= from && y < 40 - from;
    };
    const auto specks = [&](int x, int y) { return in_square(x, y, 10) ? 255 : (x + y) % 4 == 0 ? 2 : 0; };
    const auto border = [&](int x, int y) { return in_square(x, y, 10) ? 255 : in_square(x, y, 9) ? 2 : 0; };
    CHECK(threshold_of(specks) == 7.5f / 255);
    CHECK(threshold_of(border) == kVisibleAlpha);
    CHECK(threshold_of([](int x, int y) { return (x + y) % 4 == 0 ? 2 : 0; }) == kVisibleAlpha);
    CHECK(least_visible_alpha(make_image(3, 3, 3)) == kVisibleAlpha);
}
