#include "tools/tiles/set_input.h"

#include <algorithm>

#include "formats/container/container.h"
#include "formats/tileset/tile_set_files.h"
#include "libcore/base/error.h"
#include "tools/common/limits.h"

namespace imgmesh {

std::string single_tiles(const std::string& path) {
    return in_set(tile_set_folder(path), "LEVEL/COLUMN_ROW.glb") + " are ordinary containers";
}

MeshImage SetInput::read(const TileName& tile) const {
    const TileRecord* const record = find_tile(index, tile);
    if (!record || record->files.empty()) return {};
    const std::string file = in_set(folder, record->files[0].path);
    // A tile of another place or of an earlier set would do, too.
    if (!has_content(folder, record->files[0]))
        throw Error(ErrorKind::kBadFile,
                    cat(file,
                        ": is not there, or has other bytes than the index tells; the same imgmesh-build "
                        "command makes it again"));
    MeshImage image = read_container(file, limits).mesh_image;
    const GridSize size = level_size(grid(), tile);
    if (static_cast<const GridSize&>(image.source) != size)
        throw Error(ErrorKind::kBadFile, cat(file, ": is of ", image.source.width, "x", image.source.height,
                                             " pixels, expected ", size.width, "x", size.height));
    return image;
}

SourceInfo SetInput::source(int level) const {
    for (const TileRecord& record : index.tiles)
        if (record.tile.level == level && !record.files.empty()) return read(record.tile).source;
    throw Error(ErrorKind::kUnsupported, cat(path, ": level ", level, " has no tile with a mesh"));
}

bool SetInput::has_gaps() const {
    return level_totals(index, 0).pixels != std::int64_t{index.plan.width} * index.plan.height;
}

SetInput open_set(const std::string& path, int level, const ContainerLimits& limits, Context& context) {
    SetInput set{path, tile_set_folder(path), {}, container_limits(limits, context.max_memory)};
    set.index = read_index(set.folder);
    const int levels = set.grid().levels();
    if (level >= levels)
        throw Error(ErrorKind::kBadArgument,
                    cat("--level ", level, ": ", path, " has levels 0 to ", levels - 1));
    const auto missing = std::ranges::count_if(
        set.index.missing, [&](const MissingTile& tile) { return tile.tile.level == level; });
    if (missing > 0)
        context.warnings.push_back(cat(path, ": ", missing, missing == 1 ? " tile" : " tiles", " of level ",
                                       level, " could not be made and ", missing == 1 ? "is" : "are",
                                       " left out"));
    return set;
}

}  // namespace imgmesh
