// The optimiser of coded meshes: its sums over triangles against sums over pixels, and its meshes against the
// laws that a decoder relies on.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
#include <set>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/optimize/fan_fit.h"
#include "libcore/optimize/grid_optimizer.h"
#include "libcore/optimize/grid_schedule.h"
#include "libcore/optimize/grid_tiles.h"

using namespace imgmesh;

namespace {

// Waves with an edge across them, so that vertices have reasons to move.
ChannelGrid test_picture(int width, int height, int channels) {
    ChannelGrid image(width, height, channels, std::vector<float>(as_index(width * height * channels)));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) {
                const double wave = 40 * std::sin(0.21 * x + 0.4 * c) * std::cos(0.17 * y);
                image.pixel(x, y)[c] =
                    static_cast<float>(std::round(120 + wave + (3 * x + 2 * y > 2 * width + 7 * c ? 60 : 0)));
            }
    return image;
}

struct Corners {
    Place a, b, c;
};
Corners corners_of(const PlacedMesh& mesh, const Face& face) {
    return {mesh.spot[face[0]].place, mesh.spot[face[1]].place, mesh.spot[face[2]].place};
}

Moments moments_of(const RowSums& sums, const Corners& t) {
    Moments total, edge;
    for (const auto& [from, to] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)}) {
        sums.edge(from, to, edge);
        add(total, edge);
    }
    return total;
}

bool contains(const Corners& t, const Place& p) {
    return area2(t.a, t.b, p) >= 0 && area2(t.b, t.c, p) >= 0 && area2(t.c, t.a, p) >= 0;
}

// The squared error of the mesh's drawing, pixel by pixel.
double drawn_error(const PlacedMesh& mesh, const ChannelGrid& image) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Place p{kPlacesPerPixel * x, kPlacesPerPixel * y};
            for (const Face& face : mesh.faces) {
                const Corners t = corners_of(mesh, face);
                if (!contains(t, p)) continue;
                const double area = static_cast<double>(area2(t.a, t.b, t.c));
                const double weight[3] = {static_cast<double>(area2(p, t.b, t.c)) / area,
                                          static_cast<double>(area2(t.a, p, t.c)) / area,
                                          static_cast<double>(area2(t.a, t.b, p)) / area};
                for (int c = 0; c < image.channels; ++c) {
                    double drawn = 0;
                    for (std::size_t i = 0; i < 3; ++i) drawn += weight[i] * mesh.spot[face[i]].color[c];
                    sum += std::pow(drawn - image.pixel(x, y)[c], 2);
                }
                break;
            }
        }
    return sum;
}

// Whether the faces are positive and cover the image once, whether its corners are vertices, and whether all
// vertices are on the grid.
void check_legal(const PlacedMesh& mesh, const ChannelGrid& image, int step) {
    const PlaceGrid grid{image.width, image.height, step};
    std::set<std::pair<int, int>> points;
    for (const Spot& spot : mesh.spot) {
        const Place& p = spot.place;
        points.emplace(p.x, p.y);
        CHECK(grid.x(grid.column(p.x)) == p.x);
        CHECK(grid.y(grid.row(p.y)) == p.y);
    }
    CHECK(points.size() == mesh.spot.size());
    for (const int x : {0, grid.right()})
        for (const int y : {0, grid.bottom()}) CHECK(points.contains({x, y}));
    std::int64_t area = 0;
    std::set<std::pair<Id, Id>> edges;
    for (const Face& face : mesh.faces) {
        const Corners t = corners_of(mesh, face);
        CHECK(area2(t.a, t.b, t.c) > 0);
        area += area2(t.a, t.b, t.c);
        // No directed edge twice: with the area, no two faces overlap.
        for (std::size_t i = 0; i < 3; ++i) CHECK(edges.emplace(face[i], face[(i + 1) % 3]).second);
    }
    CHECK(area == 2 * std::int64_t{grid.right()} * grid.bottom());
}

constexpr int kQuarter = kPlacesPerPixel / 4;

GridOptimizer start(const RowSums& sums, int step, std::size_t vertices) {
    return GridOptimizer(sums, regular_mesh(sums, step, vertices), {.step = step});
}

PlacedMesh optimized(const ChannelGrid& image, int step, std::size_t vertices, const GridSchedule& schedule) {
    const RowSums sums(image);
    GridOptimizer optimizer = start(sums, step, vertices / 3);
    optimizer.set_vertex_count(vertices);
    optimizer.optimize(schedule);
    return optimizer.result();
}

const GridSchedule kShort{.rounds = 2, .sweeps = 10, .last_rounds = 1};

}  // namespace

TEST_CASE("moments of a triangle are those of the pixels inside it, as much as each weighs") {
    for (const auto& [channels, weighted] :
         {std::pair(1, false), {3, false}, {4, false}, {1, true}, {3, true}, {4, true}}) {
        const ChannelGrid image = test_picture(40, 30, channels);
        std::vector<float> weights;
        for (std::size_t i = 0; weighted && i < image.pixel_count(); ++i)
            weights.push_back(static_cast<float>(1 + i % 200) / 64);
        const RowSums sums(image, weights);
        std::mt19937 random(7);
        for (int trial = 0; trial < 300; ++trial) {
            const auto any = [&] {
                return Place{static_cast<int>(random() % (kPlacesPerPixel * 39 + 1)),
                             static_cast<int>(random() % (kPlacesPerPixel * 29 + 1))};
            };
            const Corners t{any(), any(), any()};
            if (area2(t.a, t.b, t.c) <= 0) continue;
            Moments slow;
            bool on_edge = false;
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x) {
                    const Place p{kPlacesPerPixel * x, kPlacesPerPixel * y};
                    if (!contains(t, p)) continue;
                    on_edge |= area2(t.a, t.b, p) == 0 || area2(t.b, t.c, p) == 0 || area2(t.c, t.a, p) == 0;
                    Double4 value = {};
                    for (int c = 0; c < channels; ++c) value[c] = image.pixel(x, y)[c];
                    const double w = weighted ? double{weights[image.index(x, y)]} : 1;
                    slow.shape += w * Double4{1, double(x), double(x * x), sum_lanes(value * value)};
                    slow.rows += w * Double4{double(y), double(x * y), double(y * y), 0};
                    slow.i += w * value;
                    slow.xi += w * x * value;
                    slow.yi += w * y * value;
                }
            // Those belong to one of two faces: see below.
            if (on_edge) continue;
            const Moments fast = moments_of(sums, t);
            for (int k = 0; k < 4; ++k) {
                CHECK(double{fast.shape[k]} == double{slow.shape[k]});
                CHECK(double{fast.rows[k]} == double{slow.rows[k]});
                CHECK(double{fast.i[k]} == double{slow.i[k]});
                CHECK(double{fast.xi[k]} == double{slow.xi[k]});
                CHECK(double{fast.yi[k]} == double{slow.yi[k]});
            }
        }
    }
}

TEST_CASE("the error is that of the drawing, and every mesh is legal") {
    for (const int channels : {1, 2, 3, 4})
        for (const int step : {1, kQuarter, 4 * kQuarter, 7 * kQuarter}) {
            const ChannelGrid image = test_picture(61, 47, channels);
            const RowSums sums(image);
            GridOptimizer optimizer = start(sums, step, 12);
            optimizer.set_vertex_count(40);
            optimizer.optimize(kShort);
            const PlacedMesh mesh = optimizer.result();
            CHECK(mesh.spot.size() == 40);
            check_legal(mesh, image, step);
            CHECK(optimizer.squared_error() == doctest::Approx(drawn_error(mesh, image)).epsilon(1e-4));
        }
}

TEST_CASE("every pixel is in one face, also on edges") {
    const ChannelGrid image = test_picture(50, 33, 3);
    const RowSums sums(image);
    // Vertices on pixel centres: many of these are on edges.
    const PlacedMesh mesh = optimized(image, 8 * kQuarter, 60, kShort);
    Moments total;
    for (const Face& face : mesh.faces) add(total, moments_of(sums, corners_of(mesh, face)));
    CHECK(double{total.shape[0]} == 50 * 33);
    CHECK(double{total.shape[1]} == 33 * 49 * 50 / 2);
    CHECK(double{total.rows[0]} == 50 * 32 * 33 / 2);
}

TEST_CASE("the number of vertices is met, up and down") {
    const ChannelGrid image = test_picture(80, 60, 3);
    const RowSums sums(image);
    GridOptimizer optimizer = start(sums, 4 * kQuarter, 4);
    CHECK(optimizer.vertices() == 4);
    for (const std::size_t vertices : {100, 104, 97, 30, 4, 50}) {
        optimizer.set_vertex_count(vertices);
        CHECK(optimizer.vertices() == vertices);
        const double before = optimizer.squared_error();
        optimizer.optimize(touch_up_schedule());
        CHECK(optimizer.vertices() == vertices);
        CHECK(optimizer.squared_error() <= before);
        check_legal(optimizer.result(), image, 4 * kQuarter);
    }
}

TEST_CASE("optimising never raises the error, and more vertices have less") {
    const ChannelGrid image = test_picture(80, 60, 3);
    const RowSums sums(image);
    GridOptimizer optimizer = start(sums, 4 * kQuarter, 30);
    double before = optimizer.squared_error();
    for (int times = 0; times < 3; ++times) {
        optimizer.optimize(kShort);
        CHECK(optimizer.squared_error() <= before);
        before = optimizer.squared_error();
    }
    optimizer.set_vertex_count(60);
    CHECK(optimizer.squared_error() < before);
}

TEST_CASE("a picture that a mesh can draw is found") {
    // A roof: two planes that meet at a column of the grid. Six vertices draw it exactly.
    ChannelGrid image(65, 33, 1, std::vector<float>(65 * 33));
    for (int y = 0; y < 33; ++y)
        for (int x = 0; x < 65; ++x) *image.pixel(x, y) = static_cast<float>(x <= 24 ? 4 * x : 96 - (x - 24));
    const RowSums sums(image);
    GridOptimizer optimizer = start(sums, 16 * kQuarter, 4);
    optimizer.set_vertex_count(6);
    optimizer.optimize(kShort);
    CHECK(optimizer.squared_error() < 65 * 33 * 1e-3);
}

TEST_CASE("the same picture gives the same mesh") {
    const ChannelGrid image = test_picture(61, 47, 3);
    const PlacedMesh one = optimized(image, 4 * kQuarter, 40, kShort),
                     two = optimized(image, 4 * kQuarter, 40, kShort);
    CHECK(one.faces == two.faces);
    for (Id v = 0; v < one.spot.size(); ++v) {
        CHECK(one.spot[v].place == two.spot[v].place);
        for (int c = 0; c < 3; ++c) CHECK(double{one.spot[v].color[c]} == double{two.spot[v].color[c]});
    }
}

TEST_CASE("the smallest pictures have four vertices") {
    const ChannelGrid image = test_picture(2, 2, 3);
    const RowSums sums(image);
    GridOptimizer optimizer = start(sums, 4 * kQuarter, 100);
    optimizer.set_vertex_count(100);
    optimizer.optimize();
    CHECK(optimizer.vertices() == 4);
    check_legal(optimizer.result(), image, 4 * kQuarter);
    CHECK(optimizer.squared_error() < 1e-3);
    CHECK_THROWS_AS(RowSums(test_picture(1, 5, 3)), Error);
    CHECK_THROWS_AS(RowSums(test_picture(5, 5, 5)), Error);
}

TEST_CASE("grid tiles: each vertex has one turn, with all that it touches, and no two claim the same") {
    // Two triangles for each cell of a grid, numbered row by row.
    constexpr Id kSide = 40;
    std::vector<Face> faces;
    for (Id y = 0; y + 1 < kSide; ++y)
        for (Id x = 0; x + 1 < kSide; ++x) {
            const Id v = y * kSide + x;
            faces.push_back({v, v + kSide, v + 1});
            faces.push_back({v + 1, v + kSide, v + kSide + 1});
        }
    const GridTiles tiles(faces, kSide * kSide);
    REQUIRE(tiles.size() == (kSide * kSide + GridTiles::kTileVertices - 1) / GridTiles::kTileVertices);
    std::vector<std::atomic<int>> turns(kSide * kSide);
    std::atomic<int> unclaimed{0};
    tiles.for_each([&](const GridTiles::Turn& turn) {
        for (Id v = turn.first; v < turn.last; ++v) ++turns[v];
        for (const Face& face : faces)
            for (const Id v : face)
                if (v >= turn.first && v < turn.last)
                    for (const Id u : face) unclaimed += !turn.claims_vertex(u);
    });
    CHECK(std::all_of(turns.begin(), turns.end(), [](const auto& n) { return n == 1; }));
    CHECK(unclaimed == 0);
}

TEST_CASE("grid optimiser: the same mesh from any number of threads") {
    const ChannelGrid image = test_picture(160, 120, 3);
    const RowSums sums(image);
    std::vector<PlacedMesh> meshes;
    for (const int threads : {1, 5}) {
        const ThreadLimit limit(threads);
        GridOptimizer optimizer = start(sums, kQuarter, 900);
        optimizer.optimize(touch_up_schedule());
        meshes.push_back(optimizer.result());
    }
    CHECK(meshes[0].faces == meshes[1].faces);
    REQUIRE(meshes[0].spot.size() == meshes[1].spot.size());
    const auto same = [](const Spot& a, const Spot& b) {
        return a.place.x == b.place.x && a.place.y == b.place.y;
    };
    CHECK(std::equal(meshes[0].spot.begin(), meshes[0].spot.end(), meshes[1].spot.begin(), same));
}
