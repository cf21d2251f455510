// What must hold for the base mesh of a tile of a larger picture, of whose sides it is decided beforehand
// which pixels stay.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/mesh/tile_sides.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"
#include "tests/support/sound_mesh.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

using Places = std::vector<std::pair<float, float>>;

// Each pixel on a side inside the mask stays with a chance of one in `one_in`; 0: corners alone.
std::vector<Id> random_sides(Size size, unsigned one_in, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<Id> kept;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const bool end_x = x == 0 || x == size.width - 1, end_y = y == 0 || y == size.height - 1;
            if ((end_x && end_y) || ((end_x || end_y) && one_in > 0 && random() % one_in == 0))
                kept.push_back(static_cast<Id>(y * size.width + x));
        }
    return kept;
}

Places places_of(const std::vector<Id>& pixels, int width) {
    Places places;
    for (const Id p : pixels)
        places.emplace_back(static_cast<float>(p % as_id(as_index(width))),
                            static_cast<float>(p / as_id(as_index(width))));
    std::sort(places.begin(), places.end());
    return places;
}

Places side_places(const BaseMesh& mesh, Size size) {
    Places places;
    for (const Vec2f& p : mesh.position)
        if (on_side(p, size.width, size.height)) places.emplace_back(p.x(), p.y());
    std::sort(places.begin(), places.end());
    return places;
}

GridMesh decided_grid(Kind kind, Size size, unsigned one_in, std::uint32_t seed) {
    GridMesh grid = grid_mesh(sample_feature(kind, size.width, size.height));
    grid.side_vertices = random_sides(size, one_in, seed);
    return grid;
}

bool same(const BaseMesh& a, const BaseMesh& b) {
    return a.position == b.position && a.feature == b.feature && a.faces == b.faces;
}

constexpr Size kSizes[] = {{2, 2}, {2, 9}, {7, 3}, {3, 3}, {16, 16}, {40, 30}, {2, 60}};

}  // namespace

TEST_CASE("decided sides: exactly their vertices are on the sides, and the rectangle is covered") {
    for (const Size size : kSizes)
        for (const Kind kind : kAllKinds)
            for (const unsigned one_in : {0u, 1u, 2u, 7u}) {
                const GridMesh grid = decided_grid(kind, size, one_in, 5 + one_in);
                const auto pixels = static_cast<std::int64_t>(grid.vertex_count());
                for (const std::int64_t target : {pixels, pixels / 2, pixels / 10, std::int64_t{0}}) {
                    INFO(name_of(kind) << " " << size.width << " x " << size.height << ", one in " << one_in
                                       << " to " << target);
                    const SimplifyResult result = simplify(grid, plain_params(), {.vertices = target});
                    check_sound(result.mesh, size);
                    CHECK((side_places(result.mesh, size) == places_of(grid.side_vertices, size.width)));
                    const auto vertices = static_cast<std::int64_t>(result.mesh.vertex_count());
                    CHECK(vertices + result.collapses == pixels);
                }
            }
}

// Vertices that go from the sides are not among those that the target counts.
TEST_CASE("decided sides: targets are met to the vertex and to the face") {
    for (const Kind kind : kAllKinds) {
        INFO(name_of(kind));
        const GridMesh grid = decided_grid(kind, {60, 50}, 6, 3);
        for (const std::int64_t target : {1200, 300, 150})
            CHECK(simplify(grid, plain_params(), {.vertices = target}).mesh.vertex_count() ==
                  static_cast<std::size_t>(target));
        for (const std::int64_t target : {2000, 400}) {
            const auto faces = static_cast<std::int64_t>(
                simplify(grid, plain_params(), {.faces = target}).mesh.faces.size());
            CHECK((faces == target || faces == target - 1));
        }
    }
}

TEST_CASE("decided sides: tiles of a large picture, with any number of threads and any kind of quadrics") {
    constexpr Size kLarge{230, 170};
    for (const Kind kind : {Kind::kNoise, Kind::kConstant, Kind::kDisc})
        for (const unsigned one_in : {0u, 12u}) {
            const GridMesh grid = decided_grid(kind, kLarge, one_in, 1);
            for (const auto& change :
                 {+[](SimplifyParams&) {}, +[](SimplifyParams& p) { p.rebuild_quadrics = true; },
                  +[](SimplifyParams& p) { p.metric = Metric::kHoppe; },
                  +[](SimplifyParams& p) { p.tiles = false; }}) {
                SimplifyParams params = plain_params();
                change(params);
                INFO(name_of(kind) << ", one in " << one_in);
                const SimplifyTarget targets[] = {{.vertices = 12000}, {.vertices = 400}, {.vertices = 150}};
                const std::vector<SimplifyResult> first = simplify(grid, params, targets);
                for (const SimplifyResult& level : first) {
                    check_sound(level.mesh, kLarge);
                    CHECK((side_places(level.mesh, kLarge) == places_of(grid.side_vertices, kLarge.width)));
                }
                const ThreadLimit limit(3);
                CHECK(same(simplify(grid, params, targets).back().mesh, first.back().mesh));
            }
        }
}

TEST_CASE("decided sides: no limit keeps a vertex that must go") {
    const GridMesh grid = decided_grid(Kind::kNoise, {40, 30}, 5, 9);
    for (const SimplifyTarget& target : {SimplifyTarget{.max_error = 0}, SimplifyTarget{.max_error = 50}}) {
        const SimplifyResult result = simplify(grid, plain_params(), target);
        CHECK(result.error <= target.max_error);
        check_sound(result.mesh, {40, 30});
        CHECK((side_places(result.mesh, {40, 30}) == places_of(grid.side_vertices, 40)));
    }
    SimplifyHooks follower;
    follower.before = [](const CollapseStep&) { return true; };
    const SimplifyTarget target{.vertices = 100};
    CHECK_THROWS_AS(simplify(grid, plain_params(), std::span(&target, 1), {}, follower), Error);
}
