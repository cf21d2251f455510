// What must hold for a base mesh that is made from another one.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/mesh/mesh_rings.h"
#include "libcore/mesh/tile_sides.h"
#include "libcore/simplify/simplify_mesh.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"
#include "tests/support/sound_mesh.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

bool is_corner(const Vec2f& p, Size size) {
    return (p.x() == 0 || p.x() == static_cast<float>(size.width - 1)) &&
           (p.y() == 0 || p.y() == static_cast<float>(size.height - 1));
}

// Every vertex on a side with a chance of one in `one_in`, and the corners.
std::vector<Id> some_side_vertices(const BaseMesh& mesh, Size size, unsigned one_in, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<Id> kept;
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        if (on_side(mesh.position[v], size.width, size.height) &&
            (is_corner(mesh.position[v], size) || random() % one_in == 0))
            kept.push_back(v);
    return kept;
}

std::vector<std::pair<float, float>> places(const BaseMesh& mesh, const std::vector<Id>& vertices) {
    std::vector<std::pair<float, float>> out;
    for (const Id v : vertices) out.emplace_back(mesh.position[v].x(), mesh.position[v].y());
    std::sort(out.begin(), out.end());
    return out;
}

std::vector<Id> all_side_vertices(const BaseMesh& mesh, Size size) {
    return some_side_vertices(mesh, size, 1, 0);
}

bool same(const BaseMesh& a, const BaseMesh& b) {
    return a.position == b.position && a.feature == b.feature && a.faces == b.faces;
}

// Four tiles of a picture of 2 n - 1 pixels a side, joined where they share vertices.
BaseMesh joined_tiles(Kind kind, int n, std::int64_t vertices_a_tile) {
    const FeatureImage whole = sample_feature(kind, 2 * n - 1, 2 * n - 1);
    BaseMesh out;
    std::map<std::pair<float, float>, Id> number;
    for (const int top : {0, n - 1})
        for (const int left : {0, n - 1}) {
            FeatureImage part{n, n, 3, {}};
            for (int y = 0; y < n; ++y)
                part.data.insert(part.data.end(), whole.pixel(left, top + y),
                                 whole.pixel(left, top + y) + 3 * n);
            GridMesh grid = grid_mesh(part);
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x)
                    if (on_side(Vec2f(static_cast<float>(x), static_cast<float>(y)), n, n) &&
                        (x % (n - 1) + y % (n - 1)) % 5 == 0)
                        grid.side_vertices.push_back(as_id(grid.feature.index(x, y)));
            const BaseMesh tile = simplify(grid, plain_params(), {.vertices = vertices_a_tile}).mesh;
            std::vector<Id> there;
            for (Id v = 0; v < tile.vertex_count(); ++v) {
                const Vec2f at = tile.position[v] + Vec2f(static_cast<float>(left), static_cast<float>(top));
                const auto [place, is_new] =
                    number.try_emplace({at.x(), at.y()}, static_cast<Id>(out.vertex_count()));
                there.push_back(place->second);
                if (!is_new) continue;
                out.position.push_back(at);
                out.feature.insert(out.feature.end(), tile.feature_of(v), tile.feature_of(v) + 3);
            }
            for (const auto& [a, b, c] : tile.faces) out.faces.push_back({there[a], there[b], there[c]});
        }
    return out;
}

// Each pixel on the sides of a 17 x 17 rectangle is a vertex, and all are joined to `hub`.
BaseMesh wheel(const Vec2f& hub) {
    BaseMesh mesh;
    std::vector<Vec2f> rim;
    for (int k = 0; k < 16; ++k) rim.emplace_back(0, k);
    for (int k = 0; k < 16; ++k) rim.emplace_back(k, 16);
    for (int k = 16; k > 0; --k) rim.emplace_back(16, k);
    for (int k = 16; k > 0; --k) rim.emplace_back(k, 0);
    mesh.position = rim;
    Id center = static_cast<Id>(std::find(rim.begin(), rim.end(), hub) - rim.begin());
    if (center == rim.size()) mesh.position.push_back(hub);
    for (Id k = 0; k < rim.size(); ++k) {
        const Id next = (k + 1) % as_id(rim.size());
        if (signed_area2(hub, rim[k], rim[next]) > 0) mesh.faces.push_back({center, k, next});
    }
    for (const Vec2f& p : mesh.position)
        mesh.feature.insert(mesh.feature.end(), {p.x(), p.y(), p.x() * p.y()});
    return mesh;
}

std::size_t most_neighbors(const BaseMesh& mesh) {
    std::vector<std::vector<Id>> around(mesh.vertex_count());
    for (const auto& [a, b] : mesh_edges(mesh)) {
        around[a].push_back(b);
        around[b].push_back(a);
    }
    std::size_t most = 0;
    for (const auto& n : around) most = std::max(most, n.size());
    return most;
}

}  // namespace

TEST_CASE("simplified meshes: four joined tiles become one, with the vertices on its sides that are given") {
    for (const Kind kind : kAllKinds)
        for (const auto& [side, vertices] : {std::pair(33, 200), std::pair(6, 20), std::pair(120, 6000)}) {
            const int n = side;
            const Size size{2 * n - 1, 2 * n - 1};
            const BaseMesh joined = joined_tiles(kind, n, vertices);
            check_sound(joined, size);
            for (const unsigned one_in : {1u, 2u, 1000u}) {
                INFO(name_of(kind) << " " << n << ", one in " << one_in);
                const std::vector<Id> kept = some_side_vertices(joined, size, one_in, 7);
                const auto target = static_cast<std::int64_t>(joined.vertex_count() / 4);
                const auto collapsed = [&](std::int64_t to) {
                    return simplify_mesh(
                        joined,
                        Vec2f(static_cast<float>(size.width - 1), static_cast<float>(size.height - 1)), kept,
                        plain_params(), {.vertices = to});
                };
                const BaseMesh mesh = collapsed(target).mesh;
                check_sound(mesh, size);
                CHECK((places(mesh, all_side_vertices(mesh, size)) == places(joined, kept)));
                if (n > 6) CHECK(mesh.vertex_count() == static_cast<std::size_t>(target));
                check_sound(collapsed(0).mesh, size);
                const ThreadLimit limit(1);
                CHECK(same(collapsed(target).mesh, mesh));
            }
        }
}

// The mesh stays as it is but for its sides, and features are those that it had.
TEST_CASE("simplified meshes: nothing collapses where the target is reached") {
    const Size size{65, 65};
    const BaseMesh joined = joined_tiles(Kind::kDisc, 33, 300);
    const BaseMesh mesh = simplify_mesh(joined, Vec2f(64, 64), all_side_vertices(joined, size),
                                        plain_params(), {.vertices = 100000})
                              .mesh;
    CHECK(mesh.position == joined.position);
    CHECK(mesh.faces.size() == joined.faces.size());
    float farthest = 0;
    for (std::size_t k = 0; k < mesh.feature.size(); ++k)
        farthest = std::max(farthest, std::abs(mesh.feature[k] - joined.feature[k]));
    CHECK(farthest < 1e-2f);
}

TEST_CASE("simplified meshes: vertices with many neighbours") {
    const Size size{17, 17};
    for (const Vec2f& hub : {Vec2f(8, 8), Vec2f(0.5f, 15.75f), Vec2f(0, 0), Vec2f(5, 16)}) {
        INFO(hub);
        BaseMesh mesh = wheel(hub);
        check_sound(mesh, size);
        CHECK(most_neighbors(mesh) > 30);
        const BaseMesh small =
            simplify_mesh(mesh, Vec2f(16, 16), some_side_vertices(mesh, size, 3, 1), plain_params(), {}).mesh;
        check_sound(small, size);
        fit_for_rings(mesh);
        check_sound(mesh, size);
        CHECK(most_neighbors(mesh) <= std::size_t{kMaxValence});
    }
}

// Two triangles that share a corner alone: a boundary that is no side of the rectangle stays as it is.
TEST_CASE("simplified meshes: fans are parted and boundaries inside stay") {
    BaseMesh mesh;
    mesh.position = {{1, 1}, {1, 3}, {3, 3}, {5, 5}, {5, 3}};
    mesh.faces = {{0, 1, 2}, {2, 3, 4}};
    mesh.feature.assign(15, 1.0f);
    const BaseMesh out = simplify_mesh(mesh, Vec2f(8, 8), {}, plain_params(), {}).mesh;
    CHECK(out.vertex_count() == 6);
    CHECK(out.faces.size() == 2);
    CHECK(mesh_quality(out).components == 2);
    CHECK_THROWS_AS(simplify_mesh(mesh, Vec2f(8, 8), {}, plain_params(Metric::kHoppe), {}), Error);
}
