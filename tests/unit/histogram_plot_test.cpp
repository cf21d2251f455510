#include "tools/common/histogram_plot.h"

#include <doctest/doctest.h>

using namespace imgmesh;

// Five values: three in the first bin, one in the second, one above. Bars of 60 % and 20 %, under an axis
// that ends at 60 % and is 150 pixels high.
TEST_CASE("histogram_plot: heights are shares, names and figures are words") {
    const Distribution d = distribution({0.1f, 0.2f, 0.3f, 0.9f, 5}, {0, 1, 2});
    const Plot plot = histogram_plot({"one<two"}, {{"a measure", {{0, d}}}});
    REQUIRE(plot.boxes.size() == 1 + 3 + 2);  // legend, three lines, two bars
    const PlotBox &high = plot.boxes[4], &low = plot.boxes[5];
    CHECK(high.height == 150);
    CHECK(low.height == 50);
    CHECK(high.x + high.width + 1 == low.x);
    CHECK(high.y + high.height == low.y + low.height);
    const std::string svg = plot_svg(plot);
    CHECK(svg.find("one&lt;two") != std::string::npos);
    CHECK(svg.find(">a measure<") != std::string::npos);
    CHECK(svg.find("mean 1.3, 0.1 to 5; 20 % above 1") != std::string::npos);
}

TEST_CASE("histogram_plot: two series share a bin, none at all is an empty panel") {
    const Distribution d = distribution({0.1f}, {0, 1, 2}), none = distribution({}, {0, 1, 2});
    const Plot plot = histogram_plot({"a", "b"}, {{"m", {{0, d}, {1, d}}}, {"n", {{1, none}}}});
    REQUIRE(plot.boxes.size() == 2 + 3 + 2 + 3);
    CHECK(plot.boxes[5].x + plot.boxes[5].width == plot.boxes[6].x);
    CHECK(plot.boxes[5].color == plot.boxes[0].color);
    CHECK(plot.boxes[6].color == plot.boxes[1].color);
}

TEST_CASE("plot_boxes: boxes in order on white, scaled") {
    Plot plot;
    plot.width = 4;
    plot.height = 3;
    plot.boxes = {{1, 1, 2, 1, Vec3f(1, 0, 0)}, {2, 1, 1, 2, Vec3f(0, 0, 1)}};
    plot.labels = {{1, 2, 10, TextAlign::kLeft, Vec3f::Zero(), "x"}};
    const Image image = plot_boxes(plot, 2);
    CHECK(image.width == 8);
    CHECK(image.height == 6);
    const auto at = [&](int x, int y) { return Vec3f(Eigen::Map<const Vec3f>(image.pixel(x, y))); };
    CHECK(at(1, 2) == Vec3f(1, 1, 1));
    CHECK(at(2, 2) == Vec3f(1, 0, 0));
    CHECK(at(3, 3) == Vec3f(1, 0, 0));
    CHECK(at(4, 3) == Vec3f(0, 0, 1));
    CHECK(at(5, 5) == Vec3f(0, 0, 1));
    CHECK(at(6, 5) == Vec3f(1, 1, 1));
    const TextLabel label = plot_labels(plot, 2).front();
    CHECK(label.x == 2);
    CHECK(label.y == 4);
    CHECK(label.size == 20);
}
