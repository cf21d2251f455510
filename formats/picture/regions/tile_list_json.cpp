#include <filesystem>

#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "formats/files/random_file.h"
#include "formats/findings/json_node.h"
#include "formats/picture/regions/tile_list.h"

namespace imgmesh {
namespace {

constexpr const char* kFormat = "imgmesh-tile-list";
constexpr int kVersion = 1;
constexpr std::uint64_t kMostBytes = std::uint64_t{256} << 20;
constexpr JsonLimits kLimits = {4, 8 * kMostTiles};
constexpr int kMostSide = 1000000;

int whole(const JsonNode& node, const char* name, int otherwise) {
    return node.has(name) ? static_cast<int>(node[name].whole(kMostSide)) : otherwise;
}

}  // namespace

bool is_json_list(const std::string& path) {
    if (lower_extension(path) != ".json") return false;
    const std::vector<std::uint8_t> start = RandomFile(path).bytes_at(0, 64);
    for (const std::uint8_t byte : start)
        if (byte != ' ' && byte != '\n' && byte != '\r' && byte != '\t') return byte == '{';
    return false;
}

TileList read_json_list(const std::string& path) {
    const std::vector<std::uint8_t> bytes = read_file(path, kMostBytes);
    const nlohmann::json document =
        whole_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, kLimits);
    const JsonNode root(document, path + ": ");
    if (!document.is_object() || !root.has("format") || !root["format"].is_text(kFormat))
        throw Error(ErrorKind::kBadFile, cat(path, ": expected JSON with the format \"", kFormat, '"'));
    if (const std::int64_t version = root.member("version").whole(1 << 20); version != kVersion)
        throw Error(ErrorKind::kUnsupported,
                    cat(path, ": version ", version, " of ", kFormat, ", expected ", kVersion));
    root.check_members({"$schema", "format", "version", "width", "height", "tiles"});
    TileList list;
    list.width = whole(root, "width", 0);
    list.height = whole(root, "height", 0);
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    for (const JsonNode& node : root.member("tiles").items(1, kMostTiles)) {
        node.check_members({"file", "x", "y", "width", "height"});
        ListedTile tile;
        tile.path = (folder / node.member("file").text()).string();
        tile.x = static_cast<int>(node.member("x").whole(kMostSide));
        tile.y = static_cast<int>(node.member("y").whole(kMostSide));
        tile.width = whole(node, "width", 0);
        tile.height = whole(node, "height", 0);
        list.tiles.push_back(std::move(tile));
    }
    return list;
}

}  // namespace imgmesh
