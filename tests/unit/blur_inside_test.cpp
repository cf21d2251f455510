// The slight blur: what can be computed by hand.
#include <doctest/doctest.h>

#include "libcore/segment/blur_inside.h"

using namespace imgmesh;

TEST_CASE("the weights are 1 4 6 4 1 both ways, and at the frame they are those of the pixels there") {
    FeatureImage image(7, 5, 3, std::vector<float>(7 * 5 * 3));
    image.pixel(3, 2)[1] = 256;
    const Cells cells(GridSize{7, 5}, 0);
    const FeatureImage blurred = blur_inside(image, cells);
    CHECK(blurred.pixel(3, 2)[1] == doctest::Approx(36));
    CHECK(blurred.pixel(2, 1)[1] == doctest::Approx(256.0f * 4 * 4 / (16 * 15)));  // a row is missing above
    CHECK(blurred.pixel(5, 2)[1] == doctest::Approx(256.0f * 1 * 6 / (15 * 16)));
    CHECK(blurred.pixel(3, 2)[0] == 0);
    CHECK(blurred.pixel(0, 0)[1] == 0);
}

TEST_CASE("pixels outside the mask do not count") {
    FeatureImage image(6, 1, 3, std::vector<float>(6 * 3, 1e9f));
    Cells cells(GridSize{6, 1}, kNone);
    for (int x = 0; x < 3; ++x) {
        cells.at(x, 0) = 0;
        for (int c = 0; c < 3; ++c) image.pixel(x, 0)[c] = float(10 * x);
    }
    const FeatureImage blurred = blur_inside(image, cells);
    CHECK(blurred.pixel(0, 0)[2] == doctest::Approx((4 * 10 + 1 * 20) / 11.0));
    CHECK(blurred.pixel(2, 0)[0] == doctest::Approx((4 * 10 + 6 * 20) / 11.0));
    CHECK(blurred.pixel(4, 0)[0] == 0);
}
