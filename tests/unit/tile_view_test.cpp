// Tiles in units of their level, and what viewers of 3D Tiles get of them.
#include "formats/tileset/tile_view.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "formats/container/validate.h"
#include "formats/findings/findings.h"
#include "formats/gltf/draco_mesh.h"
#include "formats/gltf/glb.h"
#include "tests/support/sample_tile_set.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
using namespace imgmesh::test;
using nlohmann::json;

namespace {

// The meshes of a view by their nodes' names, in pixels of the picture.
struct View {
    std::map<std::string, StoredMesh> meshes;
};

View read_view(const std::string& folder, const TileGrid& grid, const TileName& tile) {
    const std::vector<std::uint8_t> bytes = load(in_set(folder, tile_view(tile)));
    Findings findings = Findings::strict();
    const GlbView glb = unpack_glb(bytes, findings);
    const json document = json::parse(glb.json);
    View view;
    for (const json& node : document["nodes"]) {
        const json& primitive = document["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
        const json& stored =
            document["bufferViews"]
                    [primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"].get<std::size_t>()];
        const auto count = [&](const json& accessor) {
            return document["accessors"][accessor.get<std::size_t>()]["count"].get<std::uint64_t>();
        };
        StoredMesh mesh = decode_draco_mesh(glb.binary.subspan(stored["byteOffset"].get<std::size_t>(),
                                                               stored["byteLength"].get<std::size_t>()),
                                            draco_ids({}), count(primitive["attributes"]["POSITION"]),
                                            count(primitive["indices"]) / 3);
        const float scale = node["scale"][0].get<float>();
        const PixelRect rect = grid.rect(tile);
        for (auto& p : mesh.position)
            p = {p[0] * scale + static_cast<float>(rect.left), p[1] * scale - static_cast<float>(rect.top),
                 p[2] * scale};
        view.meshes[node["name"].get<std::string>()] = mesh;
    }
    return view;
}

using Corner = std::pair<std::array<float, 3>, std::array<std::uint16_t, 4>>;

// The vertices at x with their colours.
std::set<Corner> on_column(const StoredMesh& mesh, float x) {
    std::set<Corner> out;
    for (std::size_t v = 0; v < mesh.position.size(); ++v)
        if (mesh.position[v][0] == x && mesh.position[v][2] == 0)
            out.insert({mesh.position[v], mesh.color[v]});
    return out;
}

}  // namespace

TEST_CASE("coarse_image: a tile of a coarser level is a picture at half the size") {
    const TileGrid grid(100, 60, 32);  // 4 x 2 tiles, 2 x 1, 1
    CHECK(level_size(grid, {0, 0, 0}) == GridSize{33, 33});
    CHECK(level_size(grid, {0, 3, 1}) == GridSize{4, 28});
    CHECK(level_size(grid, {1, 1, 0}) == GridSize{18, 30});  // of 36 x 60 pixels
    CHECK(level_size(grid, 1) == GridSize{50, 30});
    // Each pixel of a level belongs to one tile.
    for (int level = 0; level < grid.levels(); ++level) {
        std::vector<int> owners(level_size(grid, level).pixel_count());
        for (const TileName& tile : grid.tiles(level)) {
            const PixelRect own = own_level_rect(grid, tile);
            for (int y = own.top; y < own.bottom; ++y)
                for (int x = own.left; x < own.right; ++x) ++owners[level_size(grid, level).index(x, y)];
        }
        CHECK(std::ranges::all_of(owners, [](int n) { return n == 1; }));
    }
    const MeshImage image = sample_tile(grid, {1, 1, 0});
    CHECK(!image.source.has_mask);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 18; ++x) {
            const PixelCoord& c = image.levels[0].map[image.source.index(x, y)];
            const BaseMesh& mesh = image.levels[0].mesh;
            const Face& f = mesh.faces[c.face];
            const Vec2f place =
                (1 - c.u - c.v) * mesh.position[f[0]] + c.u * mesh.position[f[1]] + c.v * mesh.position[f[2]];
            CHECK((place - Vec2f(static_cast<float>(x), static_cast<float>(y))).norm() < 1e-4f);
        }
    const BaseMesh mesh = sample_mesh(grid, {1, 1, 0});
    const std::vector<Vec2f> again = in_pixels(in_level_units(mesh, 1), 1).position;
    CHECK((again == mesh.position));
}

TEST_CASE("in_level_units: a face so thin that its nearest points lie on a line keeps its area") {
    // A square with two vertices inside, of which one lies just above the line between the other and the
    // right side. At level 3 the grid has steps of a quarter of a pixel.
    BaseMesh mesh;
    mesh.position = {{0, 0}, {64, 0}, {0, 64}, {64, 64}, {16, 32}, {40, 31.875f}, {64, 32}};
    mesh.feature.assign(3 * mesh.position.size(), 0);
    mesh.faces = {{0, 4, 5}, {0, 5, 1}, {1, 5, 6}, {4, 6, 5}, {0, 2, 4}, {2, 3, 4}, {3, 6, 4}};
    const BaseMesh level = in_level_units(mesh, 3);
    for (const Face& f : level.faces)
        CHECK(signed_area2(level.position[f[0]], level.position[f[1]], level.position[f[2]]) > 0);
    for (const Vec2f& p : level.position) CHECK(p.x() / kPositionStep == std::floor(p.x() / kPositionStep));
    for (const Vec2f& p : level.position) CHECK(p.y() / kPositionStep == std::floor(p.y() / kPositionStep));
    CHECK((8 * level.position[5] - mesh.position[5]).norm() < 0.3f);
    CHECK((level.position[6]) == Vec2f(8, 4));
}

TEST_CASE("coarse_image: pixels beside the mesh are outside of the mask") {
    const TileGrid grid(65, 65, 32);
    BaseMesh mesh = sample_mesh(grid, {1, 0, 0});
    mesh.faces.resize(mesh.faces.size() / 2);
    const MeshImage image = coarse_image(mesh, {}, grid, {1, 0, 0});
    CHECK(image.source.has_mask);
    CHECK((image.levels[0].map[image.source.index(0, 0)].face) != kNone);
    CHECK((image.levels[0].map[image.source.index(0, 32)].face) == kNone);
}

TEST_CASE("write_tile_view: neighbours have the same vertices on their side, and skirts only there") {
    const TemporaryFolder folder;
    const std::string path = folder.path().string();
    const TileGrid grid = write_sample_set(path, 100, 60, 32).plan.grid();
    const View left = read_view(path, grid, {0, 1, 0}), right = read_view(path, grid, {0, 2, 0});
    const std::set<Corner> side = on_column(left.meshes.at("tile"), 64);
    CHECK(side.size() == 5);
    CHECK(on_column(right.meshes.at("tile"), 64) == side);
    CHECK(on_column(left.meshes.at("skirt"), 64) == side);
    const View coarse = read_view(path, grid, {1, 0, 0}), coarse_right = read_view(path, grid, {1, 1, 0});
    CHECK(on_column(coarse.meshes.at("tile"), 64) == on_column(coarse_right.meshes.at("tile"), 64));
    CHECK(read_view(path, grid, {2, 0, 0}).meshes.count("skirt") == 0);

    // A frame around what the tile shares: left, below and right of (1, 0), four pixels wide.
    const StoredMesh& skirt = left.meshes.at("skirt");
    const Bounds bounds = bounds_of(skirt.position);
    CHECK(bounds.low == std::array<float, 3>{28, -36, -1});
    CHECK(bounds.high == std::array<float, 3>{68, 0, 0});
    double area = 0;
    for (const Face& f : skirt.faces) {
        const auto at = [&](std::size_t i) {
            return Vec2f(skirt.position[f[i]][0], -skirt.position[f[i]][1]);
        };
        CHECK(signed_area2(at(0), at(1), at(2)) > 0);
        area += signed_area2(at(0), at(1), at(2)) / 2;
    }
    CHECK(area == 4 * 34 + 4 * 36 + 4 * 34);  // two sides with half a corner of 4 x 4 each, one with two
    CHECK(read_view(path, grid, {1, 0, 0}).meshes.at("tile").position.size() == 5 * 5);
}

TEST_CASE("write_tile_view: every container of a set is sound") {
    const TemporaryFolder folder;
    const std::string path = folder.path().string();
    const TileSetIndex index = write_sample_set(path, 97, 65, 32);
    for (const TileRecord& record : index.tiles)
        CHECK(validate_container(in_set(path, record.files[0].path)).empty());
}

TEST_CASE("tileset_files: tiles lie in their parents, and replace them with half their error") {
    TileSetIndex index;
    index.plan = {"g", {}, 1000, 700, 16, {}, 1, 1};
    const TileGrid grid = index.plan.grid();
    for (int level = 0; level < grid.levels(); ++level)
        for (const TileName& tile : grid.tiles(level)) {
            TileRecord record{tile, "", {{tile_container(tile), 1, ""}, {tile_view(tile), 1, ""}},
                              64,   64, 100};
            record.pixels = 256;
            index.tiles.push_back(record);
        }
    CHECK(mean_spacing(index) == 2);
    std::map<std::string, json> documents;
    for (const TextFile& file : tileset_files(index)) {
        CHECK(file.text.size() < 300'000);
        documents[file.path] = json::parse(file.text);
    }
    REQUIRE(documents.count("tileset.json") == 1);
    CHECK(documents["tileset.json"]["extras"]["spacing"] == 2);
    CHECK(documents["tileset.json"]["geometricError"] == 2 * 128);
    CHECK(documents.size() == 1 + 8 * 6);  // of level 3, which begins new files

    std::set<std::string> contents;
    const std::function<void(const json&, const std::string&, double, double, double)> visit =
        [&](const json& tile, const std::string& folder, double x, double y, double parent_error) {
            if (tile.contains("transform") && tile["transform"][0] == 1 && tile["transform"][5] == 1) {
                x += tile["transform"][12].get<double>();
                y -= tile["transform"][14].get<double>();
            }
            CHECK(tile["geometricError"].get<double>() <= parent_error);
            const json& box = tile["boundingVolume"]["box"];
            const double left = x + box[0].get<double>() - box[3].get<double>(),
                         right = x + box[0].get<double>() + box[3].get<double>(),
                         top = y - box[2].get<double>() - box[11].get<double>();
            CHECK(left >= 0);
            CHECK(right <= 999);
            CHECK(top >= 0);
            if (tile.contains("content")) {
                const std::string uri =
                    std::filesystem::path(folder + tile["content"]["uri"].get<std::string>())
                        .lexically_normal()
                        .string();
                if (uri.ends_with(".json")) {
                    REQUIRE(documents.count(uri) == 1);
                    CHECK(!tile.contains("children"));
                    visit(documents[uri]["root"], std::filesystem::path(uri).parent_path().string() + "/", x,
                          y, tile["geometricError"].get<double>());
                } else {
                    CHECK(contents.insert(uri).second);
                    const TileName name = tile_from_text(uri.substr(5, uri.size() - 9));
                    CHECK(grid.rect(name).left == x);
                    CHECK(grid.rect(name).top == y);
                    CHECK(tile["geometricError"] == (name.level == 0 ? 0 : 2 << name.level));
                }
            }
            if (tile.contains("children"))
                for (const json& child : tile["children"])
                    visit(child, folder, x, y, tile["geometricError"].get<double>());
        };
    visit(documents["tileset.json"]["root"], "", 0, 0, 1e9);
    CHECK(contents.size() == index.tiles.size());
}
