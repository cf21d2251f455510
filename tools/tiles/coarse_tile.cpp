#include "tools/tiles/coarse_tile.h"

#include <utility>
#include <vector>

#include "formats/container/container.h"
#include "formats/tileset/tile_set_files.h"
#include "libcore/base/error.h"
#include "libcore/tiles/join_tiles.h"
#include "libcore/tiles/sample_tile.h"
#include "libcore/tiles/tile_units.h"

namespace imgmesh {
namespace {

// Returns the tile, or nothing where the outline of its mask, of which no vertex goes, is too fine for it:
// for its grid of positions, or with more faces than a face a pixel.
template <class Make>
std::optional<MeshImage> of_outline(const Make& make_tile) {
    try {
        MeshImage image = make_tile();
        if (image.levels.front().mesh.faces.size() <= image.source.pixel_count()) return image;
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::kInternal) throw;
    }
    return {};
}

}  // namespace

std::optional<MeshImage> read_coarse_tile(const std::string& folder, const TileGrid& grid,
                                          const TileName& tile, const SimplifyParams& params) {
    const PixelRect rect = grid.rect(tile);
    std::vector<ChildTile> children;
    SourceInfo source;
    bool masked = false;
    for (const TileName& child : grid.children(tile)) {
        if (read_record(folder, child).files.empty()) continue;  // missing, or outside the mask
        MeshImage part = read_meshes(in_set(folder, tile_container(child)));
        source = part.source;
        masked = masked || part.source.has_mask;
        const PixelRect own = grid.rect(child);
        children.push_back({in_pixels(std::move(part.levels.front().mesh), child.level), own.left - rect.left,
                            own.top - rect.top, own.width(), own.height()});
    }
    if (children.empty()) return {};
    const auto image_of = [&](const auto& make_tile) {
        return coarse_image(make_tile(children, tile.level, rect.width(), rect.height(), params), source,
                            grid, tile);
    };
    if (!masked) return image_of(coarser_tile);
    std::optional<MeshImage> image = of_outline([&] { return image_of(coarser_tile); });
    if (!image) image = image_of(sampled_tile);
    if (image->levels.front().mesh.faces.empty()) return {};
    return image;
}

}  // namespace imgmesh
