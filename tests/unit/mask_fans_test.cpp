// Fans and strips of the pixels of small masks.
#include <doctest/doctest.h>

#include <bitset>
#include <string>
#include <vector>

#include "libcore/mesh/mask_fans.h"
#include "tests/support/sample_masks.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

using Diagonals = std::bitset<4>;  // of the cells: north-east, north-west, south-west, south-east

PixelFans fans(const Mask& mask, int x, int y, Diagonals through = {}) {
    return fans_at(mask, x, y, [&](int q) { return through[static_cast<std::size_t>(q)]; });
}

// As drawn in the expectations: directions in order, a closed fan in parentheses, fans separated by a bar.
std::string text(const PixelFans& all) {
    const char* const names[] = {"E", "NE", "N", "NW", "W", "SW", "S", "SE"};
    std::string out;
    for (std::size_t n = 0; n < static_cast<std::size_t>(all.count); ++n) {
        const Fan& fan = all.fan[n];
        std::string one;
        for (std::size_t k = 0; k < static_cast<std::size_t>(fan.count); ++k)
            one += (k == 0 ? "" : " ") + std::string(names[fan.direction[k]]);
        out += (n == 0 ? "" : " | ") + (fan.closed ? "(" + one + ")" : one);
    }
    return out;
}

// The 3 x 3 mask whose center has the neighbours of `around`, bit d in direction d.
Mask mask_around(bool center, unsigned around) {
    Mask mask = mask_where(3, 3, [&](int x, int y) {
        for (int d = 0; d < 8; ++d)
            if (x == 1 + kAround[d].dx && y == 1 + kAround[d].dy) return (around >> d & 1u) != 0;
        return center;
    });
    return mask;
}

}  // namespace

// Four cells of four pixels: each is one triangle at the pixel, or two where its diagonal ends there.
TEST_CASE("fans: a pixel with all neighbours has one closed fan, with the diagonals that end at it") {
    const Mask all = mask_of({"###", "###", "###"});
    CHECK(text(fans(all, 1, 1)) == "(E N W S)");
    CHECK(text(fans(all, 1, 1, 0b1111)) == "(E NE N NW W SW S SE)");
    CHECK(text(fans(all, 1, 1, 0b0010)) == "(E N NW W S)");
    CHECK(text(fans(all, 1, 1, 0b1001)) == "(E NE N W S SE)");
}

// The image's own sides are boundaries too. Fans run counter-clockwise: at the top left corner from S to E.
TEST_CASE("fans: on a side and in a corner the fan is open") {
    const Mask all = mask_of({"###", "###", "###"});
    CHECK(text(fans(all, 0, 0)) == "S E");
    CHECK(text(fans(all, 0, 0, 0b1000)) == "S SE E");
    CHECK(text(fans(all, 2, 2)) == "N W");
    CHECK(text(fans(all, 1, 0)) == "W S E");
    CHECK(text(fans(all, 0, 1, 0b0001)) == "S E NE N");
}

// A cell of three pixels has one triangle, whatever its diagonal would be: the fourth pixel is not there.
TEST_CASE("fans: a cell of three pixels is one triangle of each of them") {
    const Mask three = mask_of({"##", "#."});
    for (const unsigned through : {0b0000u, 0b1111u}) {
        CHECK(text(fans(three, 0, 0, through)) == "S E");
        CHECK(text(fans(three, 1, 0, through)) == "W SW");
        CHECK(text(fans(three, 0, 1, through)) == "NE N");
        CHECK(text(fans(three, 1, 1, through)).empty());  // it is outside
    }
}

// A notch from the north leaves one open fan, which begins at one of its sides and ends at the other.
TEST_CASE("fans: a fan opens where a straight neighbour is missing") {
    CHECK(text(fans(mask_of({"#.#", "###", "###"}), 1, 1)) == "NW W S E NE");
    CHECK(text(fans(mask_of({"###", "###", "#.#"}), 1, 1)) == "SE E N W SW");
    // Without a diagonal neighbour its cell still has three pixels, so the fan stays closed.
    CHECK(text(fans(mask_of({"##.", "###", "###"}), 1, 1, 0b0001)) == "(E N W S)");
}

// Two cells with triangles share nothing but the pixel: it is two vertices, each with its own triangles.
TEST_CASE("fans: where the mask pinches, a pixel has a fan for each side") {
    CHECK(text(fans(mask_of({"##.", ".#.", ".##"}), 1, 1)) == "N NW | S SE");
    CHECK(text(fans(mask_of({"..#", "###", "#.."}), 1, 1)) == "E NE | W SW");
    CHECK(text(fans(mask_of({"#.#", "###", "..."}), 1, 1)) == "E NE | NW W");
}

TEST_CASE("strips: pixels without a triangle lie in a row, in a column or alone") {
    const Mask row = mask_of({"...", "###", "..."}), column = mask_of({".#.", ".#.", ".#."});
    for (int k = 0; k < 3; ++k) {
        CHECK(strip_at(row, k, 1) == Strip::kAlongX);
        CHECK(strip_at(column, 1, k) == Strip::kAlongY);
        CHECK(text(fans(row, k, 1)).empty());
    }
    CHECK(strip_at(row, 0, 0) == Strip::kNoStrip);
    // Pixels that touch at a corner alone are not beside each other.
    const Mask corners = mask_of({"#.", ".#"});
    CHECK(strip_at(corners, 0, 0) == Strip::kAlone);
    CHECK(strip_at(corners, 1, 1) == Strip::kAlone);
    // A tail of a block: its last pixel but one has triangles of the block, so the strip ends before it.
    const Mask tail = mask_of({"...##", "#####", "...##"});
    CHECK(strip_at(tail, 0, 1) == Strip::kAlongX);
    CHECK(strip_at(tail, 1, 1) == Strip::kAlongX);
    CHECK(strip_at(tail, 2, 1) == Strip::kNoStrip);
    CHECK(text(fans(tail, 2, 1)) == "SE E NE");
    CHECK(strip_at(mask_of({"..##", "####", "..##"}), 0, 1) == Strip::kAlone);
}

// Every neighbourhood there is, with all diagonals, against a count cell by cell.
TEST_CASE("fans: all 512 neighbourhoods have the triangles of their cells, each once") {
    for (unsigned around = 0; around < 256; ++around)
        for (unsigned through = 0; through < 16; ++through) {
            INFO("neighbours " << around << ", diagonals " << through);
            const PixelFans all = fans(mask_around(true, around), 1, 1, through);
            int expected = 0;
            for (unsigned q = 0; q < 4; ++q) {
                int others = 0;
                for (const unsigned d : {2 * q, 2 * q + 1, (2 * q + 2) % 8}) others += around >> d & 1u;
                if (others >= 2) expected += others == 3 && (through >> q & 1u) ? 2 : 1;
            }
            int triangles = 0;
            std::bitset<8> seen;
            for (std::size_t n = 0; n < static_cast<std::size_t>(all.count); ++n) {
                const Fan& fan = all.fan[n];
                const auto size = static_cast<std::size_t>(fan.count);
                triangles += static_cast<int>(fan.closed ? size : size - 1);
                for (std::size_t k = 0; k < size; ++k) {
                    const unsigned d = fan.direction[k];
                    CHECK((around >> d & 1u) == 1);  // a corner outside the mask is no corner
                    CHECK(!seen[d]);                 // two fans never share a neighbour
                    seen.set(d);
                    if (k + 1 == size && !fan.closed) continue;
                    const unsigned turn = (fan.direction[(k + 1) % size] + 8u - d) % 8;
                    CHECK((turn == 1 || turn == 2));  // triangles stay inside their cells
                }
            }
            CHECK(triangles == expected);
            CHECK(all.count <= 2);
            // A pixel has triangles, or it belongs to a strip.
            CHECK((strip_at(mask_around(true, around), 1, 1) == Strip::kNoStrip) == (expected > 0));
            CHECK(fans(mask_around(false, around), 1, 1, through).count == 0);
            CHECK(strip_at(mask_around(false, around), 1, 1) == Strip::kNoStrip);
        }
}
