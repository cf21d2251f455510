// Discs: cut from meshes of difficult masks, they keep every face, and their boundary is one walk around all
// of it.
#include "libcore/mesh/disc_parts.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

#include "libcore/mesh/outline.h"
#include "libcore/mesh/triangulate.h"
#include "tests/support/sample_masks.h"

using namespace imgmesh;

namespace {

using Point = std::pair<float, float>;

// Twice the area inside a part's hull; the two sides of a seam cancel out.
double hull_area2(const BaseMesh& mesh, const DiscPart& part) {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < part.hull; ++i)
        sum += signed_area2(mesh.position[part.vertex[0]], mesh.position[part.vertex[i]],
                            mesh.position[part.vertex[i + 1]]);
    return sum;
}

// Checks what disc_parts() promises of any mesh, and returns the number of hull vertices in all.
std::size_t check_parts(const BaseMesh& mesh) {
    const std::vector<DiscPart> parts = disc_parts(mesh);
    std::multiset<Face> faces;
    std::size_t hull = 0;
    for (const DiscPart& part : parts) {
        double area2 = 0;
        std::map<std::pair<Id, Id>, int> steps;  // each side of a face
        for (const auto& [a, b, c] : part.faces) {
            faces.insert({part.vertex[a], part.vertex[b], part.vertex[c]});
            area2 += signed_area2(mesh.position[part.vertex[a]], mesh.position[part.vertex[b]],
                                  mesh.position[part.vertex[c]]);
            for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
                CHECK(++steps[{from, to}] == 1);
        }
        // Exactly the sides without one that runs back are the hull, in its order.
        std::set<std::pair<Id, Id>> boundary, expected;
        for (const auto& [side, count] : steps)
            if (!steps.contains({side.second, side.first})) boundary.insert(side);
        for (std::size_t i = 0; i < part.hull; ++i) expected.insert({as_id(i), as_id((i + 1) % part.hull)});
        CHECK(boundary == expected);
        CHECK(hull_area2(mesh, part) == doctest::Approx(area2));
        CHECK(area2 > 0);
        hull += part.hull;
    }
    CHECK(faces == std::multiset<Face>(mesh.faces.begin(), mesh.faces.end()));
    return hull;
}

BaseMesh mesh_of(const Mask& mask) {
    return triangulated(mask_contours(mask));
}

}  // namespace

TEST_CASE("disc parts: of difficult masks keep every face, and each hull is one walk") {
    for (const auto& [name, mask] : test::sample_masks(24)) {
        INFO(name);
        check_parts(mesh_of(mask));
    }
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        INFO(seed);
        check_parts(mesh_of(test::random_mask(seed)));
    }
}

TEST_CASE("disc parts: one pixel, pixels that touch at a corner, an island in a hole, counted by hand") {
    const BaseMesh one = mesh_of(test::mask_of({"#"}));
    const std::vector<DiscPart> parts = disc_parts(one);
    REQUIRE(parts.size() == 1);
    CHECK(parts[0].hull == 4);
    CHECK(parts[0].faces.size() == 2);
    CHECK(hull_area2(one, parts[0]) == 2);

    const BaseMesh touching = mesh_of(test::mask_of({"#.", ".#"}));
    CHECK(disc_parts(touching).size() == 2);
    CHECK(check_parts(touching) == 8);

    // The ring has 8 corners. Its seam joins two of them, and gives each a copy; the island is apart.
    const BaseMesh island = mesh_of(test::mask_of({"#####", "#...#", "#.#.#", "#...#", "#####"}));
    CHECK(disc_parts(island).size() == 2);
    CHECK(check_parts(island) == 8 + 2 + 4);

    // Each further hole takes one more seam.
    const BaseMesh holes = mesh_of(test::mask_of({"#######", "#.#.#.#", "#######"}));
    CHECK(disc_parts(holes).size() == 1);
    CHECK(check_parts(holes) == 16 + 6);
}

TEST_CASE("disc parts: a seam takes the shortest way, through vertices inside too") {
    // A square of 10 x 10 with a square hole of 2 x 2 in its middle, in a grid of 2 x 2 cells.
    BaseMesh mesh;
    mesh.channels = 0;
    for (int y = 0; y <= 10; y += 2)
        for (int x = 0; x <= 10; x += 2) mesh.position.emplace_back(float(x), float(y));
    for (Id y = 0; y < 5; ++y)
        for (Id x = 0; x < 5; ++x) {
            if (x == 2 && y == 2) continue;
            const Id a = 6 * y + x;
            mesh.faces.push_back({a, a + 6, a + 1});
            mesh.faces.push_back({a + 1, a + 6, a + 7});
        }
    const std::vector<DiscPart> parts = disc_parts(mesh);
    REQUIRE(parts.size() == 1);
    // 20 corners outside, 4 of the hole; a seam of two edges gives a copy to both ends, and two to its
    // middle.
    CHECK(parts[0].hull == 20 + 4 + 2 + 2);
    CHECK(check_parts(mesh) == 28);

    // Faces that share only a vertex.
    BaseMesh bow;
    bow.channels = 0;
    bow.position = {{0, 0}, {0, 2}, {1, 1}, {2, 2}, {2, 0}};
    bow.faces = {{0, 1, 2}, {2, 3, 4}};
    CHECK(disc_parts(bow).size() == 2);
    CHECK(check_parts(bow) == 6);

    // A vertex without a face is left out.
    mesh.position.emplace_back(100.0f, 100.0f);
    CHECK(check_parts(mesh) == 28);
    CHECK(disc_parts(BaseMesh{}).empty());
}
