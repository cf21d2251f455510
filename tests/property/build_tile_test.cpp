// Two tiles of a picture that share a line of pixels: what is on the line is the same in both.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/metrics/metrics.h"
#include "libcore/pipeline/build_tile.h"
#include "libcore/pipeline/presets.h"
#include "libcore/tiles/simplify_side.h"
#include "tests/support/sample_masks.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

Image crop(const Image& whole, const PixelRect& rect) {
    Image part = whole;
    part.width = rect.width();
    part.height = rect.height();
    part.data.clear();
    for (int y = rect.top; y < rect.bottom; ++y)
        part.data.insert(part.data.end(), whole.pixel(rect.left, y),
                         whole.pixel(rect.left, y) + whole.channels * rect.width());
    return part;
}

Image photograph(int width, int height) {
    static const Image whole = read_image(IMGMESH_TEST_DATA "/kodim05.png");
    return crop(whole, {300, 200, 300 + width, 200 + height});
}

// The photograph with an alpha channel that falls to the right.
Image with_alpha(const Image& rgb) {
    Image out = make_image(rgb.width, rgb.height, 4);
    for (int y = 0; y < rgb.height; ++y)
        for (int x = 0; x < rgb.width; ++x) {
            float* pixel = &out.data[4 * out.index(x, y)];
            std::copy_n(rgb.pixel(x, y), 3, pixel);
            pixel[3] = 1 - static_cast<float>(x) / static_cast<float>(rgb.width);
        }
    return out;
}

TileCommon common_of(const Image& picture, const BuildParams& params, Gamut gamut = Gamut::kDisplay) {
    TileCommon common;
    common.space = tile_space(picture, params, gamut);
    common.density = 3;
    return common;
}

Side side_of(const Image& picture, const PixelRect& line, const BuildParams& params,
             const TileCommon& common) {
    const FeatureImage feature = tile_features(crop(picture, line), common);
    Side side = simplify_side(feature.data, feature.channels, {.threshold = 20});
    round_tile_features(side.features, params, common);
    return side;
}

struct Size {
    int width, height;
};

struct Tile {
    Image image;
    TileSides sides;
    Level level;
};

Tile tile_of(const Image& picture, const PixelRect& rect, const BuildParams& params,
             const TileCommon& common) {
    const auto [left, top, right, bottom] = rect;
    Tile tile;
    tile.image = crop(picture, rect);
    tile.sides = {side_of(picture, {left, top, right, top + 1}, params, common),
                  side_of(picture, {left, bottom - 1, right, bottom}, params, common),
                  side_of(picture, {left, top, left + 1, bottom}, params, common),
                  side_of(picture, {right - 1, top, right, bottom}, params, common)};
    Image image = tile.image;
    tile.level = build_tile(std::move(image), params, tile.sides, common).mesh_image.levels.at(0);
    return tile;
}

// The vertices at x, from top to bottom, each with its features.
std::vector<std::vector<float>> vertices_at(const BaseMesh& mesh, float x) {
    std::vector<std::vector<float>> out;
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        if (mesh.position[v].x() != x) continue;
        std::vector<float>& all = out.emplace_back(1, mesh.position[v].y());
        all.insert(all.end(), mesh.feature_of(v), mesh.feature_of(v) + mesh.channels);
    }
    std::sort(out.begin(), out.end());
    return out;
}

double feature_at(const Level& level, const PixelCoord& coord, int c) {
    const auto [i, j, k] = level.mesh.faces[coord.face];
    const auto f = [&](Id v) { return double{level.mesh.feature_of(v)[c]}; };
    return (1.0 - coord.u - coord.v) * f(i) + coord.u * f(j) + coord.v * f(k);
}

void check_sound(const Tile& tile) {
    const Level& level = tile.level;
    const MeshQuality mesh = mesh_quality(level.mesh);
    CHECK(mesh.flipped_faces + mesh.nonmanifold_edges + mesh.nonmanifold_vertices == 0);
    CHECK(mesh.euler == 1);
    CHECK(mesh.area == double(tile.image.width - 1) * (tile.image.height - 1));
    const MapQuality map = map_quality(level.mesh, level.map);
    CHECK(map.flipped_triangles + map.unmapped + map.outside_simplex == 0);
    const auto right = static_cast<float>(tile.image.width - 1);
    CHECK(vertices_at(level.mesh, 0).size() == tile.sides.left.vertices.size());
    CHECK(vertices_at(level.mesh, right).size() == tile.sides.right.vertices.size());
}

// Builds two tiles that share the column in the middle, and compares what is there.
void check_neighbors(const Image& picture, const BuildParams& params, const TileCommon& common) {
    const int middle = picture.width / 2 - 3, last = picture.width, height = picture.height;
    const Tile a = tile_of(picture, {0, 0, middle + 1, height}, params, common);
    const Tile b = tile_of(picture, {middle, 0, last, height}, params, common);
    check_sound(a);
    check_sound(b);
    CHECK((vertices_at(a.level.mesh, static_cast<float>(middle)) == vertices_at(b.level.mesh, 0)));
    const std::vector<Vec2d> in_a = mapped_positions(a.level.mesh, a.level.map),
                             in_b = mapped_positions(b.level.mesh, b.level.map);
    for (int y = 0; y < height; ++y) {
        const Vec2d p = in_a[a.image.index(middle, y)], q = in_b[b.image.index(0, y)];
        CHECK(p.x() == middle);
        CHECK(q.x() == 0);
        CHECK(p.y() == q.y());
        for (int c = 0; c < a.level.mesh.channels; ++c)
            CHECK(feature_at(a.level, a.level.map.at(middle, y), c) ==
                  doctest::Approx(feature_at(b.level, b.level.map.at(0, y), c)).epsilon(1e-6));
    }
    const ThreadLimit one(1);
    const Tile again = tile_of(picture, {middle, 0, last, height}, params, common);
    CHECK(again.level.mesh.position == b.level.mesh.position);
    CHECK(again.level.mesh.feature == b.level.mesh.feature);
    CHECK(again.level.mesh.faces == b.level.mesh.faces);
    CHECK(again.level.map == b.level.map);
}

BuildParams by_error(BuildParams params, double error = 2000) {
    params.stop.error = error;
    params.anneal = std::min<std::int64_t>(params.anneal, 20);
    return params;
}

}  // namespace

TEST_CASE("tiles: neighbours agree on their common line after every preset, with any number of threads") {
    const Image picture = photograph(110, 60);
    for (const Preset& preset : presets())
        for (const bool compact : {false, true}) {
            INFO(std::string(preset.name) << " " << compact);
            BuildParams params = by_error(preset.params);
            if (compact) params.mesh_precision = MeshPrecision::kCompact;
            check_neighbors(picture, params, common_of(picture, params));
        }
}

TEST_CASE("tiles: of any size and of difficult pictures they are sound") {
    for (const Kind kind : kAllKinds)
        for (const Size& size : {Size{2, 2}, {2, 17}, {3, 3}, {17, 16}, {90, 3}, {64, 50}})
            for (const double exchange : {0.0, 0.3}) {
                INFO(name_of(kind) << " " << size.width << " x " << size.height << " " << exchange);
                const Image picture = sample_picture(kind, size.width, size.height);
                BuildParams params = by_error({});
                params.exchange = exchange;
                params.anneal = exchange > 0 ? 10 : 0;
                TileCommon common = common_of(picture, params);
                for (const double threshold : {1.0, 1e3, 1e9}) {
                    common.max_increment = threshold;
                    check_sound(tile_of(picture, {0, 0, size.width, size.height}, params, common));
                }
            }
}

TEST_CASE("tiles: neighbours agree with other maps, objectives, channels and colours") {
    const Image picture = photograph(110, 60);
    const auto check = [&](const Image& image, const BuildParams& params, Gamut gamut = Gamut::kDisplay) {
        check_neighbors(image, params, common_of(image, params, gamut));
    };
    BuildParams params = by_error({});
    SUBCASE("a trivial map") {
        params.map = MapKind::kTrivial;
        check(picture, params);
    }
    SUBCASE("no map") {
        params.map = MapKind::kTrivial;
        params.map_is_left_out = true;
        check(picture, params);
    }
    SUBCASE("colours of the quadrics") {
        params.quadric_colors = true;
        check(picture, params);
    }
    SUBCASE("the objective rgb") {
        params.objective = Objective::kRgb;
        params.exchange = 0.2;
        params.anneal = 10;
        check(picture, params);
    }
    SUBCASE("displacements that cost") {
        params.map_rate = 2;
        params.map_steps = 8;
        check(picture, params);
    }
    SUBCASE("alpha") {
        params.channels = {{"R"}, {"G"}, {"B"}, {"A", kAlphaWeight}};
        check(with_alpha(picture), params);
    }
    SUBCASE("alpha with weighted colours") {
        params.channels = {{"R", 0.3}, {"G", 0.3}, {"B", 0.3}, {"A", kAlphaWeight}};
        check(with_alpha(picture), params);
    }
    SUBCASE("HDR, though one tile has nothing bright") {
        Image bright = picture;
        bright.color_space = ColorSpace::kLinear;
        bright.sample_type = SampleType::kFloat;
        for (int y = 10; y < 30; ++y) bright.data[3 * bright.index(80, y)] = 7;
        params.refine = 0;
        check(bright, params, Gamut::kHdr);
    }
    SUBCASE("HDR without HDR colours in the space") {
        Image bright = picture;
        bright.sample_type = SampleType::kFloat;
        bright.data[3 * bright.index(80, 20)] = 7;
        check(bright, params);
    }
}

TEST_CASE("tiles: one threshold gives more vertices where there is more to see") {
    const Image picture = photograph(110, 60);
    const BuildParams params = by_error({});
    TileCommon common = common_of(picture, params);
    std::size_t before = 0;
    for (const double threshold : {3000.0, 300.0, 30.0}) {
        common.max_increment = threshold;
        const Tile tile = tile_of(picture, {0, 0, 110, 60}, params, common);
        check_sound(tile);
        CHECK(tile.level.mesh.vertex_count() > before);
        before = tile.level.mesh.vertex_count();
    }
}

// The conversion works on several pixels at once, wherever they are in a row.
TEST_CASE("tiles: a line of pixels has the features that it has in the tile") {
    const Image picture = with_alpha(photograph(61, 40));
    BuildParams params;
    params.channels = {{"R"}, {"G"}, {"B"}, {"A", kAlphaWeight}};
    for (const bool alpha : {false, true}) {
        if (!alpha) params.channels.clear();
        const TileCommon common = common_of(picture, params);
        const FeatureImage whole = tile_features(picture, common);
        for (int x = 0; x < 61; x += 7) {
            const FeatureImage line = tile_features(crop(picture, {x, 0, x + 1, 40}), common);
            for (int y = 0; y < 40; ++y)
                CHECK(std::equal(line.pixel(0, y), line.pixel(0, y) + line.channels, whole.pixel(x, y)));
        }
        for (int y = 0; y < 40; y += 9) {
            const FeatureImage line = tile_features(crop(picture, {3, y, 50, y + 1}), common);
            CHECK(std::equal(line.data.begin(), line.data.end(), whole.pixel(3, y)));
        }
    }
}

// Of a line that the mask cuts all pixels inside are vertices, in their own colours, and they rest.
TEST_CASE("tiles: masks may cross the common line") {
    for (const NamedMask& sample : sample_masks(40)) {
        const Mask& mask = sample.mask;
        if (std::min(mask.width, mask.height) < 5) continue;
        INFO(sample.name);
        const Image picture = sample_picture(Kind::kNoise, mask.width, mask.height);
        const BuildParams params = by_error({});
        const TileCommon common = common_of(picture, params);
        const auto tile_at = [&](const PixelRect& rect) {
            const auto [left, top, right, bottom] = rect;
            const Mask part = mask_where(rect.width(), rect.height(), [&, l = left, t = top](int x, int y) {
                return mask.at(l + x, t + y) != 0;
            });
            const auto side_at = [&](const PixelRect& line) {
                const FeatureImage feature = tile_features(crop(picture, line), common);
                const int length = std::max(line.width(), line.height());
                const bool across = line.height() == 1;
                Side side;
                for (int k = 0; k < length; ++k) {
                    if (!mask.at(line.left + (across ? k : 0), line.top + (across ? 0 : k))) continue;
                    side.vertices.push_back(k);
                    const float* f = feature.pixel(across ? k : 0, across ? 0 : k);
                    side.features.insert(side.features.end(), f, f + 3);
                }
                round_tile_features(side.features, params, common);
                return side;
            };
            Tile tile{crop(picture, rect),
                      {side_at({left, top, right, top + 1}), side_at({left, bottom - 1, right, bottom}),
                       side_at({left, top, left + 1, bottom}), side_at({right - 1, top, right, bottom})},
                      {}};
            if (part.count() == 0) return tile;
            Image image = tile.image;
            tile.level =
                build_tile(std::move(image), params, tile.sides, common, {}, part).mesh_image.levels.at(0);
            return tile;
        };
        const int middle = mask.width / 2;
        const Tile a = tile_at({0, 0, middle + 1, mask.height}),
                   b = tile_at({middle, 0, mask.width, mask.height});
        for (const Tile* tile : {&a, &b}) {
            if (tile->level.map.empty()) continue;
            const MeshQuality mesh = mesh_quality(tile->level.mesh);
            CHECK(mesh.flipped_faces + mesh.nonmanifold_edges + mesh.nonmanifold_vertices == 0);
            const MapQuality map = map_quality(tile->level.mesh, tile->level.map, true);
            CHECK(map.flipped_triangles + map.unmapped + map.outside_simplex == 0);
        }
        // The pixels on the line rest in both; those of strips one pixel wide up to the rounding of weights.
        for (const auto& [tile, x] : {std::pair(&a, middle), std::pair(&b, 0)}) {
            if (tile->level.map.empty()) continue;
            const std::vector<Vec2d> at = mapped_positions(tile->level.mesh, tile->level.map);
            for (int y = 0; y < mask.height; ++y)
                if (mask.at(middle, y)) CHECK((at[tile->image.index(x, y)] - Vec2d(x, y)).norm() < 1e-5);
        }
    }
}

TEST_CASE("tiles: what is not for tiles is refused") {
    const Image picture = photograph(30, 20);
    const auto kind_of = [&](const BuildParams& params, auto&& change) {
        const BuildParams plain = by_error({});
        const TileCommon common = common_of(picture, plain);
        TileSides sides = tile_of(picture, {0, 0, 30, 20}, plain, common).sides;
        change(sides);
        try {
            Image image = picture;
            build_tile(std::move(image), params, sides, common);
        } catch (const Error& e) {
            return e.kind();
        }
        return ErrorKind::kInternal;
    };
    const auto nothing = [](TileSides&) {};
    BuildParams tracked, rms, pyramid, values;
    tracked.map = MapKind::kTracked;
    tracked.refine = 0;
    rms.stop.rms = 3;
    pyramid.levels.count = 2;
    values.values = true;
    for (const BuildParams& params : {tracked, rms, pyramid, values})
        CHECK(kind_of(params, nothing) == ErrorKind::kUnsupported);
    const BuildParams plain = by_error({});
    const auto bad = [&](auto&& change) { return kind_of(plain, change) == ErrorKind::kBadArgument; };
    CHECK(bad([](TileSides& sides) { sides.top.vertices.back() = 28; }));
    CHECK(bad([](TileSides& sides) { sides.left.features.pop_back(); }));
    CHECK(bad([](TileSides& sides) { sides.right.shifts.assign(19, 0.0f); }));
    CHECK(bad([](TileSides& sides) { sides.top.shifts[4] = sides.top.shifts[3] - 1; }));
    CHECK(bad([](TileSides& sides) {
        sides.top.shifts.assign(30, 0.0f);
        sides.left.shifts.assign(20, 0.0f);
        for (std::size_t k = 1; k < 15; ++k) sides.top.shifts[k] = sides.left.shifts[k] = 1;
    }));
}
