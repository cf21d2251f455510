#include "formats/tileset/tile_files.h"

#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>

#include "formats/files/sha256.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

namespace fs = std::filesystem;

// The one way to write a number, so that a tile has one name.
std::optional<int> plain_number(std::string_view text) {
    int number = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool plain = !text.empty() && (text == "0" || (text[0] >= '1' && text[0] <= '9'));
    if (!plain || fault != std::errc() || end != text.data() + text.size()) return {};
    return number;
}

}  // namespace

std::string tile_text(const TileName& tile) {
    return std::to_string(tile.level) + '/' + std::to_string(tile.column) + '_' + std::to_string(tile.row);
}

TileName tile_from_text(const std::string& text) {
    const std::string_view view = text;
    const std::size_t slash = view.find('/'), line = view.find('_');
    if (slash != std::string::npos && line != std::string::npos && slash < line) {
        const std::optional<int> level = plain_number(view.substr(0, slash)),
                                 column = plain_number(view.substr(slash + 1, line - slash - 1)),
                                 row = plain_number(view.substr(line + 1));
        if (level && column && row) return {*level, *column, *row};
    }
    throw Error(ErrorKind::kBadArgument,
                cat('"', text, "\" is no name of a tile, expected LEVEL/COLUMN_ROW as in 0/3_5"));
}

std::string tile_container(const TileName& tile) {
    return tile_text(tile) + ".glb";
}
std::string tile_record(const TileName& tile) {
    return tile_text(tile) + ".json";
}
std::string tile_view(const TileName& tile) {
    return "view/" + tile_text(tile) + ".glb";
}

std::string in_set(const std::string& folder, const std::string& path) {
    return (fs::path(folder) / path).string();
}

void make_level_folders(const std::string& folder, int level) {
    for (const char* place : {"", "view/"}) {
        const std::string path = in_set(folder, place + std::to_string(level));
        std::error_code error;
        fs::create_directories(path, error);
        if (error) throw Error(ErrorKind::kIo, cat(path, ": cannot be made as a folder: ", error.message()));
    }
}

TileFile file_facts(const std::string& folder, const std::string& path) {
    const std::string full = in_set(folder, path);
    std::error_code error;
    const std::uint64_t bytes = fs::file_size(full, error);
    const std::string hash = error ? "" : file_sha256_hex(full);
    if (hash.empty()) throw Error(ErrorKind::kIo, cat(full, ": cannot be read"));
    return {path, bytes, hash};
}

bool has_content(const std::string& folder, const TileFile& file) {
    const std::string full = in_set(folder, file.path);
    std::error_code error;
    const std::uint64_t bytes = fs::file_size(full, error);
    return !error && bytes == file.bytes && file_sha256_hex(full) == file.sha256;
}

}  // namespace imgmesh
