#include "tools/tiles/old_set.h"

#include <filesystem>
#include <optional>

#include "formats/tileset/tile_set_files.h"
#include "libcore/base/error.h"
#include "tools/common/text.h"
#include "tools/tiles/tile_jobs.h"

namespace fs = std::filesystem;

namespace imgmesh {
namespace {

// Returns the plan of the set in the folder; nothing if there is no set.
std::optional<TileSetPlan> old_plan(const std::string& folder) {
    for (const char* const name : {kPlanFile, kIndexFile, kTilesetFile, kThresholdFile}) {
        if (!fs::exists(in_set(folder, name))) continue;
        try {
            return name == kIndexFile ? read_index(folder).plan : read_plan(folder);
        } catch (const Error& error) {
            throw Error(ErrorKind::kBadArgument,
                        cat("-o ", folder, ": has a file ", name,
                            " that is not of a tile set that imgmesh knows; expected a new folder or one of "
                            "such a set (",
                            error.what(), ")"));
        }
    }
    return {};
}

void remove_file(const fs::path& path) {
    std::error_code error;
    fs::remove(path, error);
    if (error) throw Error(ErrorKind::kIo, cat(path.string(), ": cannot remove: ", error.message()));
}

// Returns the tile whose file this is; nothing for other files.
std::optional<TileName> tile_of(const std::string& level, const fs::path& file) {
    if (file.extension() != ".glb" && file.extension() != ".json") return {};
    try {
        return tile_from_text(level + "/" + file.stem().string());
    } catch (const Error&) {
        return {};
    }
}

std::vector<fs::path> entries(const fs::path& folder) {
    std::vector<fs::path> all;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
        all.push_back(entry.path());
    return all;
}

// Removes from the levels in a folder the files that `keeps(tile, extension)` tells not to keep.
template <class Keeps>
std::int64_t remove_tiles(const fs::path& folder, const Keeps& keeps) {
    std::int64_t removed = 0;
    for (const fs::path& level : entries(folder)) {
        if (!fs::is_directory(level)) continue;
        for (const fs::path& file : entries(level)) {
            const std::optional<TileName> tile = tile_of(level.filename().string(), file);
            if (!tile || keeps(*tile, file.extension()) || !fs::is_regular_file(fs::symlink_status(file)))
                continue;
            remove_file(file);
            ++removed;
        }
        std::error_code is_not_empty;
        if (removed > 0) fs::remove(level, is_not_empty);
    }
    return removed;
}

// Says which set was there, in a few words.
std::string described(const TileSetPlan& before, const TileSetPlan& plan) {
    const TileSource &old = before.source, &own = plan.source;
    const std::string name = printable_line(old.path);
    if (old.bytes != own.bytes || old.stamp != own.stamp)
        return cat("a tile set of ", name, old.path == own.path ? " as it was before" : "");
    return cat("a tile set of ", name, " by ",
               before.generator == plan.generator ? "other options" : "another version");
}

}  // namespace

std::int64_t make_way(const std::string& folder, const TileSetPlan& plan, bool overwrite,
                      std::vector<std::string>& warnings) {
    const std::optional<TileSetPlan> before = old_plan(folder);
    if (!before || plan_key(*before) == plan_key(plan)) return 0;
    const std::string old = described(*before, plan);
    if (!overwrite)
        throw Error(ErrorKind::kIo, cat(folder, ": exists with ", old, ", and is not overwritten"));
    warnings.push_back(cat(folder, ": held ", old, ", which is replaced"));
    for (const char* const name : {kIndexFile, kTilesetFile, kThresholdFile})
        remove_file(in_set(folder, name));
    const TileGrid grid = plan.grid();
    const auto claimed = [&](const TileName& tile, const fs::path&) { return grid.contains(tile); };
    // The .json there are parts of the tileset, which the index's job writes.
    const auto claimed_view = [&](const TileName& tile, const fs::path& extension) {
        return grid.contains(tile) && extension != ".json";
    };
    return remove_tiles(folder, claimed) + remove_tiles(in_set(folder, "view"), claimed_view);
}

}  // namespace imgmesh
