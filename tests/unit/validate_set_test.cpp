// A sound tile set has no findings, and each thing that is broken is found.
#include "formats/tileset/validate_set.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <set>

#include "formats/tileset/set_findings.h"
#include "tests/support/sample_tile_set.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

std::set<std::string> codes(const std::string& folder) {
    std::set<std::string> out;
    for (const Issue& issue : validate_tile_set(folder)) out.emplace(issue.finding->code);
    return out;
}

void save(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

// A set of 8, 2 and 1 tiles, of which one can be made anew.
struct SmallSet {
    TemporaryFolder folder;
    std::string path = folder.path().string();
    TileSetIndex index = write_sample_set(path, 97, 65, 32);

    // Replaces a tile and tells the index of it.
    void replace(const TileName& tile, const MeshImage& image) {
        for (TileRecord& record : index.tiles)
            if (record.tile == tile) record = write_sample_tile(path, index.plan, tile, image);
        write_tileset(path, index);
        write_index(path, index);
    }
};

}  // namespace

TEST_CASE("validate_tile_set: a sound set has no findings") {
    const SmallSet set;
    CHECK(codes(set.path).empty());
    // 100 is not a whole number of pixels at half and at a quarter of the size.
    const TemporaryFolder uneven;
    write_sample_set(uneven.path().string(), 100, 60, 32);
    CHECK(codes(uneven.path().string()).empty());
}

TEST_CASE("validate_tile_set: files that are broken or gone") {
    SmallSet set;
    const std::string view = set.folder / "view/0/1_0.glb", tile = set.folder / "0/1_0.glb";
    std::filesystem::rename(view, view + "x");
    CHECK(codes(set.path) == std::set<std::string>{"set.file"});
    std::filesystem::rename(view + "x", view);
    std::filesystem::copy_file(set.folder / "0/0_0.glb", tile,
                               std::filesystem::copy_options::overwrite_existing);
    CHECK(codes(set.path) == std::set<std::string>{"set.file"});
    set.replace({0, 1, 0}, sample_tile(set.index.plan.grid(), {0, 1, 0}));
    CHECK(codes(set.path).empty());
    save(set.folder / "0/2_0.json", "{}");
    save(set.folder / "tileset.json", "{}");
    CHECK(codes(set.path) == std::set<std::string>{"set.record", "set.tileset"});
    save(set.folder / "index.json", "{}");
    CHECK(codes(set.path) == std::set<std::string>{"set.index"});
}

TEST_CASE("validate_tile_set: a tile that is not there is a warning") {
    SmallSet set;
    set.index.missing = {{set.index.tiles[3].tile, "a broken strip"}};
    set.index.tiles.erase(set.index.tiles.begin() + 3);
    write_tileset(set.path, set.index);
    write_index(set.path, set.index);
    const std::vector<Issue> issues = validate_tile_set(set.path);
    REQUIRE(issues.size() == 1);
    CHECK((issues[0].finding->code) == "set.missing");
    CHECK((issues[0].finding->severity) == Severity::kWarning);
}

TEST_CASE("validate_tile_set: sides that do not agree") {
    const TileName tile{0, 1, 0};
    SmallSet set;
    const TileGrid grid = set.index.plan.grid();
    const MeshImage sound = sample_tile(grid, tile);
    const auto left = [](const Vec2f& p) { return p.x() == 0 && p.y() == 8; };

    MeshImage image = sound;
    BaseMesh& mesh = image.levels[0].mesh;
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        if (left(mesh.position[v])) {
            const Vec3f other = sample_color(1000, 1000);
            std::copy(other.data(), other.data() + 3, mesh.feature_of(v));
        }
    set.replace(tile, image);
    CHECK(codes(set.path) == std::set<std::string>{"set.side"});

    BaseMesh moved = sample_mesh(grid, tile);
    for (Vec2f& p : moved.position)
        if (left(p)) p.y() += kPositionStep;
    set.replace(tile, coarse_image(moved, sound.source, grid, tile));
    CHECK(codes(set.path) == std::set<std::string>{"set.side", "set.pixels"});

    // Pixels that the neighbour lacks may be missing; where both have some, they agree.
    MeshImage masked = sound;
    masked.source.has_mask = true;
    for (int y = 0; y < 8; ++y) masked.levels[0].map[masked.source.index(0, y)] = {};
    set.replace(tile, masked);
    CHECK(codes(set.path).empty());
    masked = coarse_image(moved, sound.source, grid, tile);
    masked.source.has_mask = true;
    set.replace(tile, masked);
    CHECK(codes(set.path) == std::set<std::string>{"layers.mask_unused", "set.side", "set.pixels"});

    // A pixel of the side that lies elsewhere on it.
    image = sound;
    PixelCoord& c = image.levels[0].map[image.source.index(0, 3)];
    const Face& face = mesh.faces[c.face];
    std::array<float, 3> weight = {1 - c.u - c.v, c.u, c.v};
    std::size_t a = 3, b = 3;
    for (std::size_t i = 0; i < 3; ++i)
        if (weight[i] != 0) (a == 3 ? a : b) = i;
    REQUIRE(b < 3);
    REQUIRE(mesh.position[face[a]].x() == 0);
    weight[a] += 0.0625f;
    weight[b] -= 0.0625f;
    c.u = weight[1];
    c.v = weight[2];
    set.replace(tile, image);
    CHECK(codes(set.path) == std::set<std::string>{"set.pixels"});
}

TEST_CASE("validate_tile_set: a tile of another place or with another count") {
    SmallSet set;
    const TileGrid grid = set.index.plan.grid();
    set.replace({0, 0, 1}, sample_tile(TileGrid(97, 60, 32), {0, 0, 1}));
    CHECK(codes(set.path) == std::set<std::string>{"set.size"});
    set.replace({0, 0, 1}, sample_tile(grid, {0, 0, 1}));
    for (TileRecord& record : set.index.tiles)
        if (record.tile.level == 2) ++record.faces;
    write_index(set.path, set.index);
    CHECK(codes(set.path) == std::set<std::string>{"set.counts"});
}

TEST_CASE("kSetFindings: the page lists them all") {
    const std::vector<std::uint8_t> bytes = load(IMGMESH_DOCS "/tile-sets.md");
    const std::string page(bytes.begin(), bytes.end());
    std::size_t rows = 0;
    for (std::size_t at = page.find("\n| `set."); at != std::string::npos;
         at = page.find("\n| `set.", at + 1))
        ++rows;
    CHECK(rows == std::size(kSetFindings));
    for (const Finding& f : kSetFindings) {
        const std::string row = "| `" + std::string(f.code) + "` | " +
                                (f.severity == Severity::kError ? "error" : "warning") + " | " +
                                std::string(f.meaning) + " |\n";
        INFO(row);
        CHECK(page.find(row) != std::string::npos);
    }
}
