// Edges without pixels of mixed colour: what can be computed by hand.
#include <doctest/doctest.h>

#include "libcore/segment/clean_edges.h"

using namespace imgmesh;

TEST_CASE("a soft edge becomes a sharp one") {
    // Columns of lightness 10 and 90 with two mixed ones between them.
    const float columns[] = {10, 10, 10, 10, 30, 70, 90, 90, 90, 90};
    FeatureImage image(10, 6, 3, std::vector<float>(10 * 6 * 3));
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 10; ++x) image.pixel(x, y)[0] = columns[x];
    const FeatureImage clean = clean_edges(image, Cells(GridSize{10, 6}, 0));
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 10; ++x) {
            // The square of a mixed pixel is the one that reaches away from the edge.
            const float expected = x < 4 ? 10.0f : x == 4 ? 50.0f / 3 : x == 5 ? 250.0f / 3 : 90.0f;
            CHECK(clean.pixel(x, y)[0] == doctest::Approx(expected));
            CHECK(clean.pixel(x, y)[1] == 0);
        }
}

TEST_CASE("a uniform image stays, and pixels outside the mask do not count") {
    FeatureImage image(5, 1, 3, std::vector<float>(5 * 3, 1e9f));
    Cells cells(GridSize{5, 1}, kNone);
    for (int x = 0; x < 2; ++x) {
        cells.at(x, 0) = 0;
        for (int c = 0; c < 3; ++c) image.pixel(x, 0)[c] = 40;
    }
    const FeatureImage clean = clean_edges(image, cells);
    CHECK(clean.pixel(0, 0)[0] == 40);
    CHECK(clean.pixel(1, 0)[2] == 40);
    CHECK(clean.pixel(3, 0)[0] == 0);
}
