// The JSON of tile sets: what is written comes back, and what is broken or hostile is refused.
#include "formats/tileset/tile_set_files.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "libcore/base/error.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

// Two tiles of level 0 and one of level 1.
TileSetPlan small_plan() {
    return {"imgmesh-build 0.1.0",
            {"a picture.tif", 12345, "1700000000000000000"},
            100,
            60,
            64,
            {{"preset", "balanced"}, {"keep", "0.1"}},
            1.5,
            {}};
}

void save(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

// A record whose files are there, with other figures for each tile.
TileRecord record_in(const std::string& folder, const TileName& tile, const std::string& key) {
    make_level_folders(folder, tile.level);
    save(in_set(folder, tile_container(tile)), "container of " + tile_text(tile));
    save(in_set(folder, tile_view(tile)), "view of " + tile_text(tile));
    TileRecord record{tile, key, {}, 0, 0};
    record.files = {file_facts(folder, tile_container(tile)), file_facts(folder, tile_view(tile))};
    record.vertices = 10 + tile.column;
    record.own_vertices = 9;
    record.faces = 20;
    if (tile.level > 0) return record;
    record.pixels = 3000;
    record.map_squares = 27000.1;
    record.gouraud_squares = 30000.3;
    record.seam_pixels = 94;
    record.seam_squares = 0.1;
    return record;
}

TileSetIndex small_index(const std::string& folder) {
    TileSetIndex index{small_plan(), 0.25, {}, {}};
    for (const TileName& tile : {TileName{0, 0, 0}, TileName{1, 0, 0}})
        index.tiles.push_back(record_in(folder, tile, plan_key(index.plan)));
    index.missing = {{{0, 1, 0}, "a broken strip"}};
    return index;
}

std::string text_of(const std::string& path) {
    const std::vector<std::uint8_t> bytes = load(path);
    return {bytes.begin(), bytes.end()};
}

template <typename Read>
std::string refusal(const Read& read, ErrorKind kind = ErrorKind::kBadFile) {
    try {
        read();
    } catch (const Error& error) {
        CHECK(error.kind() == kind);
        CHECK(std::string(error.what()).find('\n') == std::string::npos);
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("tile_text: a tile has one name") {
    CHECK(tile_text({3, 14, 5}) == "3/14_5");
    CHECK(tile_from_text("3/14_5") == TileName{3, 14, 5});
    for (const char* text : {"", "3", "3/1", "3/1_", "/1_2", "03/1_2", "3/+1_2", "3/-1_2", "3/1_2 ",
                             "3/1_2_4", "3/1_99999999999", "../1_2", "3_1/2"})
        CHECK_THROWS_AS(tile_from_text(text), Error);
    CHECK(tile_view({1, 0, 2}) == "view/1/0_2.glb");
}

TEST_CASE("plan_key: all of a plan decides what the tiles are, but not where the source lies") {
    const TileSetPlan plan = small_plan();
    TileSetPlan other = plan;
    other.source.path = "elsewhere.tif";
    CHECK(plan_key(other) == plan_key(plan));
    std::swap(other.parameters[0], other.parameters[1]);
    CHECK(plan_key(other) == plan_key(plan));
    other.threshold = 1;
    CHECK(plan_key(other) != plan_key(plan));
    other = plan;
    other.source.stamp = "2";
    CHECK(plan_key(other) != plan_key(plan));
    other = plan;
    other.parameters[0].second = "fast";
    CHECK(plan_key(other) != plan_key(plan));
}

TEST_CASE("write_plan: comes back") {
    const TemporaryFolder folder;
    const std::string path = folder.path().string();
    TileSetPlan plan = small_plan();
    plan.threshold = 0.1;
    write_plan(path, plan);
    const TileSetPlan again = read_plan(path);
    CHECK(plan_key(again) == plan_key(plan));
    CHECK(again.source.path == plan.source.path);
    CHECK(again.threshold.value() == 0.1);
    CHECK(again.grid().count() == 3);
}

TEST_CASE("is_finished: a record of this plan whose files are as it says") {
    const TemporaryFolder folder;
    const std::string path = folder.path().string(), key = plan_key(small_plan());
    const TileName tile{0, 1, 0};
    CHECK(!is_finished(path, tile, key));
    const TileRecord record = record_in(path, tile, key);
    CHECK(!is_finished(path, tile, key));  // files without a record are an unfinished tile
    write_record(path, record);
    CHECK(is_finished(path, tile, key));
    CHECK(!is_finished(path, {0, 0, 0}, key));
    CHECK(!is_finished(path, tile, std::string(64, '0')));
    const TileRecord again = read_record(path, tile);
    CHECK(again.files == record.files);
    CHECK(again.gouraud_squares == record.gouraud_squares);

    const std::string view = in_set(path, tile_view(tile)), before = text_of(view);
    std::string changed = before;
    changed[3] ^= 1;
    save(view, changed);
    CHECK(!is_finished(path, tile, key));
    save(view, before.substr(1));
    CHECK(!is_finished(path, tile, key));
    std::filesystem::remove(view);
    CHECK(!is_finished(path, tile, key));
    save(view, before);
    CHECK(is_finished(path, tile, key));
    // Another tile's record is none of this one.
    std::filesystem::copy_file(in_set(path, tile_record(tile)), in_set(path, tile_record({0, 0, 0})));
    CHECK(!is_finished(path, {0, 0, 0}, key));
    // A tile without a pixel inside the mask has no files; one that could not be made is not finished.
    TileRecord empty{{0, 0, 0}, key, {}};
    write_record(path, empty);
    CHECK(is_finished(path, {0, 0, 0}, key));
    empty.missing = "a broken strip";
    write_record(path, empty);
    CHECK(!is_finished(path, {0, 0, 0}, key));
    CHECK(read_record(path, {0, 0, 0}).missing == "a broken strip");
}

TEST_CASE("write_index: comes back, with sums over each level") {
    const TemporaryFolder folder;
    const std::string path = folder.path().string();
    CHECK(!is_tile_set(path));
    TileSetIndex index = small_index(path);
    write_index(path, index);
    CHECK(is_tile_set(path));
    CHECK(is_tile_set(folder / "index.json"));
    CHECK(!is_tile_set(folder / "0/0_0.json"));
    CHECK(tile_set_folder(folder / "index.json") == path);

    const TileSetIndex again = read_index(path);
    REQUIRE(again.tiles.size() == 2);
    CHECK(again.tiles[0].files == index.tiles[0].files);
    CHECK(again.tiles[1].key == plan_key(index.plan));
    CHECK(again.missing[0].reason == "a broken strip");
    CHECK(find_tile(again, {1, 0, 0}) == &again.tiles[1]);
    CHECK(find_tile(again, {0, 1, 0}) == nullptr);
    CHECK(level_totals(again, 0).map_rms == std::sqrt(27000.1 / 3000));
    CHECK(level_totals(again, 1).vertices == 10);
    // The same bytes again.
    const std::string text = text_of(folder / "index.json");
    write_index(path, again);
    CHECK(text_of(folder / "index.json") == text);
}

TEST_CASE("read_index: refuses what is broken or leads out of the folder") {
    const TemporaryFolder folder;
    const std::string path = folder.path().string();
    write_index(path, small_index(path));
    const std::string sound = text_of(folder / "index.json");
    const auto refused = [&](const std::string& from, const std::string& to) {
        std::string text = sound;
        const std::size_t at = text.find(from);
        REQUIRE(at != std::string::npos);
        save(folder / "index.json", text.replace(at, from.size(), to));
        return refusal([&] { read_index(path); });
    };
    for (const char* out : {"../0_0.glb", "/etc/passwd", "view//0.glb", "view/./0.glb", "view/", "", "a\\b",
                            "c:x", "a\\u0000b", "view/.."})
        CHECK(refused("view/0/0_0.glb", out).find("index.json: /tiles/0/files/1/path: not a path below") !=
              std::string::npos);
    CHECK(refused("\"0/0_0.glb\"", "\"0/1_0.glb\"").find("to be the first") != std::string::npos);
    CHECK(refused("\"0/0_0\"", "\"0/2_0\"") != "");
    CHECK(refused("\"0/0_0\"", "\"0/1_0\"") != "");
    CHECK(refused("\"tile\":\"1/0_0\"", "\"tile\":\"0/0_0\"") != "");
    CHECK(refused("\"vertices\":10", "\"vertices\":-1") != "");
    CHECK(refused("\"vertices\":10", "\"vertices\":1e300") != "");
    CHECK(refused("\"vertices\":10", "\"verts\":10") != "");
    CHECK(refused("\"width\": 100", "\"width\": 101") != "");  // the key is of another plan
    CHECK(refused("\"width\": 100", "\"width\": 0") != "");
    CHECK(refused("\"tile\": 64", "\"tile\": 1") != "");
    CHECK(refused("\"levels\": 2", "\"levels\": 3") != "");
    CHECK(refused("a broken strip", "a \\ud800 strip") != "");
    CHECK(refused("\"missing\": [", "\"missing\": [{\"tile\":\"1/0_0\",\"reason\":\"\"},") != "");
    CHECK(refused("\"map_squares\":27000.1", "\"map_squares\":1e999") != "");
    save(folder / "index.json", sound.substr(0, sound.size() / 2));
    CHECK(refusal([&] { read_index(path); }).find("no JSON") != std::string::npos);
    std::string newer = sound;
    save(folder / "index.json", newer.replace(newer.find("\"version\": 1"), 12, "\"version\": 2"));
    CHECK(refusal([&] { read_index(path); }, ErrorKind::kUnsupported) != "");
    save(folder / "index.json", sound);
    CHECK(refusal([&] { read_index(path); }) == "");
}

TEST_CASE("read_index: a large index comes back whole") {
    const TemporaryFolder folder;
    const std::string path = folder.path().string();
    TileSetIndex index{small_plan(), 0.25, {}, {}};
    index.plan.width = index.plan.height = 64 * 60 + 1;  // 60 x 60 tiles, and a third more above them
    const TileGrid grid = index.plan.grid();
    for (int level = 0; level < grid.levels(); ++level)
        for (const TileName& tile : grid.tiles(level)) {
            TileRecord record{tile, "", {}, 1000, 990, 2000, 4096, 12345.678, 23456.789, 128, 456.789};
            for (const std::string& file : {tile_container(tile), tile_view(tile)})
                record.files.push_back({file, 123456, std::string(64, 'a')});
            index.tiles.push_back(record);
        }
    REQUIRE(index.tiles.size() > 4'000);
    write_index(path, index);
    const TileSetIndex again = read_index(path);
    CHECK(again.tiles.size() == index.tiles.size());
}

TEST_CASE("read_index: the examples are judged as the schemas judge them") {
    int count[2] = {0, 0};
    for (const bool valid : {false, true})
        for (const auto& entry : std::filesystem::directory_iterator(
                 std::string(IMGMESH_SCHEMAS "/examples/") + (valid ? "valid" : "invalid"))) {
            const std::string name = entry.path().filename().string();
            if (!name.starts_with("imgmesh-tileset.")) continue;
            const TemporaryFolder folder;
            const std::string path = folder.path().string();
            std::filesystem::create_directories(folder / "0");
            const bool plan = name.find(".plan.") != std::string::npos,
                       tile = name.find(".tile.") != std::string::npos;
            std::filesystem::copy_file(entry.path(), folder / (plan   ? "plan.json"
                                                               : tile ? "0/1_0.json"
                                                                      : "index.json"));
            bool accepted = true;
            try {
                if (plan)
                    read_plan(path);
                else if (tile)
                    read_record(path, {0, 1, 0});
                else
                    read_index(path);
            } catch (const Error&) {
                accepted = false;
            }
            INFO(name);
            CHECK(accepted == valid);
            ++count[valid];
        }
    CHECK((count[0]) > 3);
    CHECK((count[1]) > 2);
}
