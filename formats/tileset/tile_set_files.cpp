#include "formats/tileset/tile_set_files.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "formats/files/atomic_file.h"
#include "formats/files/sha256.h"
#include "formats/findings/json_node.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int kVersion = 1;
constexpr const char* kPlanFormat = "imgmesh-tile-plan";
constexpr const char* kTileFormat = "imgmesh-tile";
constexpr const char* kSetFormat = "imgmesh-tile-set";

// A record has some hundred bytes, and an index as many for each tile.
constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 20;
constexpr JsonLimits kLimits = {8, std::size_t{1} << 24};
// As doubles these are exact.
constexpr std::int64_t kMostCount = std::int64_t{1} << 53;
constexpr double kMostSum = std::numeric_limits<double>::max();
constexpr std::size_t kMostFiles = 16;

// --- writing

json head(const char* format, const char* schema) {
    return {{"$schema", std::string("imgmesh-tileset.") + schema + ".schema.json"},
            {"format", format},
            {"version", kVersion}};
}

json plan_members(const TileSetPlan& plan) {
    // A reader gets them by name, and must come to the same key.
    auto sorted = plan.parameters;
    std::ranges::sort(sorted);
    json parameters = json::object();
    for (const auto& [name, value] : sorted) parameters[name] = value;
    json members = {
        {"generator", plan.generator},
        {"source", {{"path", plan.source.path}, {"bytes", plan.source.bytes}, {"stamp", plan.source.stamp}}},
        {"width", plan.width},
        {"height", plan.height},
        {"tile", plan.tile},
        {"levels", plan.grid().levels()},
        {"parameters", std::move(parameters)},
        {"density", plan.density}};
    if (plan.threshold) members["threshold"] = *plan.threshold;
    return members;
}

json record_members(const TileRecord& record) {
    json files = json::array();
    for (const TileFile& file : record.files)
        files.push_back({{"path", file.path}, {"bytes", file.bytes}, {"sha256", file.sha256}});
    json members = {{"tile", tile_text(record.tile)},
                    {"vertices", record.vertices},
                    {"own_vertices", record.own_vertices},
                    {"faces", record.faces},
                    {"files", std::move(files)}};
    if (record.tile.level == 0)
        members.update({{"pixels", record.pixels},
                        {"map_squares", record.map_squares},
                        {"gouraud_squares", record.gouraud_squares},
                        {"seam_pixels", record.seam_pixels},
                        {"seam_squares", record.seam_squares}});
    return members;
}

json totals_member(const TileSetIndex& index, int level) {
    const TileTotals t = level_totals(index, level);
    json member = {{"tiles", t.tiles},
                   {"vertices", t.vertices},
                   {"own_vertices", t.own_vertices},
                   {"faces", t.faces},
                   {"bytes", t.bytes}};
    if (level == 0)
        member.update({{"pixels", t.pixels},
                       {"map_rms", t.map_rms},
                       {"gouraud_rms", t.gouraud_rms},
                       {"seam_rms", t.seam_rms}});
    return member;
}

// Names of files need not be UTF-8; JSON must be.
std::string text_of_json(const json& document, int indent) {
    return document.dump(indent, ' ', false, json::error_handler_t::replace) + '\n';
}

void write(const std::string& folder, const std::string& name, const std::string& text) {
    AtomicFile file(in_set(folder, name), /*overwrite=*/true);
    file.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    file.commit();
}

// --- reading

nlohmann::json load(const std::string& path, const char* format) {
    const std::vector<std::uint8_t> bytes = read_file(path, kMostBytes, FileKind::kRegular);
    nlohmann::json document =
        whole_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, kLimits);
    const JsonNode root(document, path + ": ");
    if (!document.is_object() || !root.has("format") || !root["format"].is_text(format))
        throw Error(ErrorKind::kBadFile, cat(path, ": expected JSON with the format \"", format, '"'));
    if (const std::int64_t version = root.member("version").whole(kMostCount); version != kVersion)
        throw Error(ErrorKind::kUnsupported,
                    cat(path, ": version ", version, " of ", format, ", expected ", kVersion));
    return document;
}

TileSetPlan plan_of(const JsonNode& node) {
    TileSetPlan plan;
    const auto most_int = [](const JsonNode& number) {
        return static_cast<int>(number.whole(std::numeric_limits<int>::max()));
    };
    plan.generator = node.member("generator").text();
    const JsonNode source = node.member("source");
    source.check_members({"path", "bytes", "stamp"});
    plan.source.path = source.member("path").text();
    plan.source.bytes = static_cast<std::uint64_t>(source.member("bytes").whole(kMostCount));
    plan.source.stamp = source.member("stamp").text();
    plan.width = most_int(node.member("width"));
    plan.height = most_int(node.member("height"));
    plan.tile = most_int(node.member("tile"));
    const JsonNode parameters = node.member("parameters");
    if (!parameters.value().is_object()) parameters.refuse("expected an object");
    for (const auto& [name, value] : parameters.value().items())
        plan.parameters.emplace_back(name, JsonNode(value, parameters.place() + '/' + name).text());
    plan.density = node.member("density").number(0, kMostSum);
    if (node.has("threshold")) plan.threshold = node["threshold"].number(0, kMostSum);
    try {
        const std::int64_t levels = node.member("levels").whole(kMostCount);
        if (levels != plan.grid().levels())
            node["levels"].refuse(cat("expected ", plan.grid().levels(), ", found ", levels));
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::kBadFile) throw;
        node.refuse(error.what());  // of the grid
    }
    return plan;
}

// Of what is read, nothing may lead out of the folder.
bool stays_below(const std::string& path) {
    if (path.empty() || path.back() == '/') return false;
    for (const char c : path)
        if (static_cast<unsigned char>(c) < 0x20 || c == '\\' || c == ':' || c == 0x7F) return false;
    for (std::size_t at = 0; at <= path.size();) {
        const std::size_t end = std::min(path.find('/', at), path.size());
        const std::string_view part = std::string_view(path).substr(at, end - at);
        if (part.empty() || part == "." || part == "..") return false;
        at = end + 1;
    }
    return true;
}

TileFile file_of(const JsonNode& node) {
    node.check_members({"path", "bytes", "sha256"});
    TileFile file{node.member("path").text(),
                  static_cast<std::uint64_t>(node.member("bytes").whole(kMostCount)),
                  node.member("sha256").text()};
    if (!stays_below(file.path)) node["path"].refuse("not a path below the set's folder");
    if (file.sha256.size() != 64 || file.sha256.find_first_not_of("0123456789abcdef") != std::string::npos)
        node["sha256"].refuse("expected 64 digits in lower-case hex");
    return file;
}

TileName name_of(const JsonNode& node) {
    const JsonNode tile = node.member("tile");
    try {
        return tile_from_text(tile.text());
    } catch (const Error& error) {
        tile.refuse(error.what());
    }
}

TileRecord record_of(const JsonNode& node) {
    TileRecord record;
    record.tile = name_of(node);
    record.vertices = node.member("vertices").whole(kMostCount);
    record.own_vertices = node.member("own_vertices").whole(record.vertices);
    record.faces = node.member("faces").whole(kMostCount);
    for (const JsonNode& file : node.member("files").items(0, kMostFiles))
        record.files.push_back(file_of(file));
    if (record.files.empty() ? record.faces > 0 : record.files[0].path != tile_container(record.tile))
        node["files"].refuse(cat("expected ", tile_container(record.tile), " to be the first"));
    if (record.tile.level > 0) return record;
    record.pixels = node.member("pixels").whole(kMostCount);
    record.map_squares = node.member("map_squares").number(0, kMostSum);
    record.gouraud_squares = node.member("gouraud_squares").number(0, kMostSum);
    record.seam_pixels = node.member("seam_pixels").whole(kMostCount);
    record.seam_squares = node.member("seam_squares").number(0, kMostSum);
    return record;
}

// Each tile of the picture must be in one of the two lists, which have an order.
void check_tiles(const TileSetIndex& index, const JsonNode& root) {
    const TileGrid grid = index.plan.grid();
    const auto check = [&](const auto& list, const char* member) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            const auto refuse = [&](const char* text) {
                root[member].refuse(cat("tile ", tile_text(list[i].tile), ' ', text));
            };
            if (!grid.contains(list[i].tile)) refuse("is not one of the picture");
            if (i > 0 && !comes_before(list[i - 1].tile, list[i].tile)) refuse("is not in its order");
        }
    };
    check(index.tiles, "tiles");
    check(index.missing, "missing");
    for (const MissingTile& missing : index.missing)
        if (find_tile(index, missing.tile))
            root["missing"].refuse(cat("tile ", tile_text(missing.tile), " is in both lists"));
    if (const auto all = static_cast<std::int64_t>(index.tiles.size() + index.missing.size());
        all != grid.count())
        root["tiles"].refuse(cat("expected ", grid.count(), " tiles with the missing ones, found ", all));
}

}  // namespace

std::string plan_key(const TileSetPlan& plan) {
    json members = plan_members(plan);
    members["source"].erase("path");
    const std::string text = text_of_json(members, -1);
    return sha256_hex({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void write_plan(const std::string& folder, const TileSetPlan& plan) {
    json document = head(kPlanFormat, "plan");
    document.update(plan_members(plan));
    document["key"] = plan_key(plan);
    write(folder, kPlanFile, text_of_json(document, 2));
}

TileSetPlan read_plan(const std::string& folder) {
    const std::string path = in_set(folder, kPlanFile);
    const nlohmann::json document = load(path, kPlanFormat);
    const JsonNode root(document, path + ": ");
    root.check_members({"$schema", "format", "version", "generator", "source", "width", "height", "tile",
                        "levels", "parameters", "density", "threshold", "key"});
    return plan_of(root);
}

void write_record(const std::string& folder, const TileRecord& record) {
    json document = head(kTileFormat, "tile");
    document["key"] = record.key;
    document.update(record_members(record));
    if (!record.missing.empty()) document["missing"] = record.missing;
    write(folder, tile_record(record.tile), text_of_json(document, 2));
}

TileRecord read_record(const std::string& folder, const TileName& tile) {
    const std::string path = in_set(folder, tile_record(tile));
    const nlohmann::json document = load(path, kTileFormat);
    const JsonNode root(document, path + ": ");
    root.check_members({"$schema", "format", "version", "key", "tile", "vertices", "own_vertices", "faces",
                        "files", "pixels", "map_squares", "gouraud_squares", "seam_pixels", "seam_squares",
                        "missing"});
    TileRecord record = record_of(root);
    if (root.has("missing")) record.missing = root["missing"].text();
    if (!record.missing.empty() && !record.files.empty()) root["files"].refuse("a missing tile has none");
    record.key = root.member("key").text();
    if (record.tile != tile) root["tile"].refuse(cat("expected ", tile_text(tile)));
    return record;
}

void write_index(const std::string& folder, const TileSetIndex& index) {
    json document = head(kSetFormat, "index");
    document["plan"] = plan_members(index.plan);
    document["key"] = plan_key(index.plan);
    document["threshold"] = index.threshold;
    json levels = json::array();
    for (int level = 0; level < index.plan.grid().levels(); ++level)
        levels.push_back(totals_member(index, level));
    document["levels"] = std::move(levels);
    json missing = json::array();
    for (const MissingTile& tile : index.missing)
        missing.push_back({{"tile", tile_text(tile.tile)}, {"reason", tile.reason}});
    document["missing"] = std::move(missing);
    // A line for each tile.
    std::string text = document.dump(2, ' ', false, json::error_handler_t::replace);
    text.erase(text.rfind("\n}"));
    text += ",\n  \"tiles\": [";
    for (std::size_t i = 0; i < index.tiles.size(); ++i)
        text += (i == 0 ? "\n    " : ",\n    ") + record_members(index.tiles[i]).dump();
    text += "\n  ]\n}\n";
    write(folder, kIndexFile, text);
}

TileSetIndex read_index(const std::string& folder) {
    const std::string path = in_set(folder, kIndexFile);
    if (!fs::exists(fs::symlink_status(path)) && fs::exists(in_set(folder, kPlanFile)))
        throw Error(
            ErrorKind::kBadFile,
            cat(folder, ": is a tile set that is not complete; the same imgmesh-build command goes on"));
    const nlohmann::json document = load(path, kSetFormat);
    const JsonNode root(document, path + ": ");
    root.check_members(
        {"$schema", "format", "version", "plan", "key", "threshold", "levels", "missing", "tiles"});
    TileSetIndex index;
    root.member("plan").check_members(
        {"generator", "source", "width", "height", "tile", "levels", "parameters", "density", "threshold"});
    index.plan = plan_of(root["plan"]);
    index.threshold = root.member("threshold").number(0, kMostSum);
    const std::string key = plan_key(index.plan);
    if (root.member("key").text() != key) root["key"].refuse("not that of the plan");
    for (const JsonNode& node : root.member("tiles").items()) {
        node.check_members({"tile", "vertices", "own_vertices", "faces", "files", "pixels", "map_squares",
                            "gouraud_squares", "seam_pixels", "seam_squares"});
        index.tiles.push_back(record_of(node));
        index.tiles.back().key = key;
    }
    for (const JsonNode& node : root.member("missing").items()) {
        node.check_members({"tile", "reason"});
        index.missing.push_back({name_of(node), node.member("reason").text()});
    }
    check_tiles(index, root);
    const std::vector<JsonNode> levels = root.member("levels").items();
    bool right = levels.size() == static_cast<std::size_t>(index.plan.grid().levels());
    for (std::size_t k = 0; right && k < levels.size(); ++k)
        right = levels[k].value() == nlohmann::json(totals_member(index, static_cast<int>(k)));
    if (!right) root["levels"].refuse("not the sums over the tiles");
    return index;
}

bool is_finished(const std::string& folder, const TileName& tile, const std::string& key) {
    try {
        const TileRecord record = read_record(folder, tile);
        if (record.key != key || !record.missing.empty()) return false;
        for (const TileFile& file : record.files)
            if (!has_content(folder, file)) return false;
        return true;
    } catch (const Error&) {
        return false;  // no record, or one that is worth nothing
    }
}

bool is_tile_set(const std::string& path) {
    std::error_code error;
    if (fs::is_directory(path, error))
        return fs::is_regular_file(in_set(path, kIndexFile), error) ||
               fs::is_regular_file(in_set(path, kPlanFile), error);
    return fs::path(path).filename() == kIndexFile && fs::is_regular_file(path, error);
}

std::string tile_set_folder(const std::string& path) {
    std::error_code error;
    if (fs::is_directory(path, error)) return path;
    const std::string folder = fs::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

}  // namespace imgmesh
