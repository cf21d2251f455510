#include <doctest/doctest.h>

#include <string_view>

#include "libcore/simplify/kernel/border_rules.h"

using namespace imgmesh;

namespace {

// A vertex of the rectangle [0, 9] x [0, 5] by the name of what it is on: I the inside; L, R, T, B a side
// (left, right, top, bottom); 1, 2, 3, 4 the corners from top left to bottom right, row by row.
constexpr std::string_view kPlaces = "ILRTB1234";

// What two vertices may become, with the first vertex's row and the second one's column, both in the order of
// kPlaces. A side or corner stands for a vertex that stays on it, I for one that may go anywhere, a point for
// a merge that is forbidden: it would take a corner away or pull a side off its line.
constexpr std::string_view kMerged[] = {
    "ILRTB1234",  // I
    "LL...1.3.",  // L
    "R.R...2.4",  // R
    "T..T.12..",  // T
    "B...B..34",  // B
    "11.1.1...",  // 1
    "2.22..2..",  // 2
    "33..3..3.",  // 3
    "4.4.4...4",  // 4
};

std::uint8_t fixed_axes(char place) {
    switch (place) {
        case 'I':
            return 0;
        case 'L':
        case 'R':
            return kFixedX;
        case 'T':
        case 'B':
            return kFixedY;
        default:
            return kFixedX | kFixedY;
    }
}
float fixed_x(char place) {
    return place == 'L' || place == '1' || place == '3' ? 0 : 9;
}
float fixed_y(char place) {
    return place == 'T' || place == '1' || place == '2' ? 0 : 5;
}

// (x, y): where the vertex is along the axes that it may move along.
Ring vertex(char place, float x, float y) {
    Ring ring;
    ring.fixed = fixed_axes(place);
    ring.x = ring.fixed & kFixedX ? fixed_x(place) : x;
    ring.y = ring.fixed & kFixedY ? fixed_y(place) : y;
    return ring;
}

}  // namespace

TEST_CASE("border rules: where two vertices may merge, for any two places in the rectangle") {
    for (std::size_t a = 0; a < kPlaces.size(); ++a)
        for (std::size_t b = 0; b < kPlaces.size(); ++b) {
            INFO(kPlaces[a] << " with " << kPlaces[b]);
            const char merged = kMerged[a][b];
            CHECK(merged == kMerged[b][a]);  // a misprint in the table itself
            const BorderConstraint constraint =
                border_constraint(vertex(kPlaces[a], 3, 2), vertex(kPlaces[b], 4, 1));
            CHECK(constraint.allowed == (merged != '.'));
            if (!constraint.allowed) continue;
            CHECK(constraint.fixed == fixed_axes(merged));
            if (constraint.fixed & kFixedX) CHECK(constraint.x == fixed_x(merged));
            if (constraint.fixed & kFixedY) CHECK(constraint.y == fixed_y(merged));
        }
}

// An image one pixel wide is a strip from -0.5 to 0.5: its long sides are close, and yet may not merge.
TEST_CASE("border rules: the sides of a strip one pixel wide stay apart") {
    Ring left, right, left_too;
    left.fixed = right.fixed = left_too.fixed = kFixedX;
    left.x = left_too.x = -0.5f;
    right.x = 0.5f;
    left.y = right.y = 3;
    left_too.y = 4;
    CHECK_FALSE(border_constraint(left, right).allowed);
    const BorderConstraint along = border_constraint(left, left_too);
    CHECK(along.allowed);
    CHECK(along.fixed == kFixedX);
    CHECK(along.x == -0.5f);
}
