#include "formats/tileset/tile_set.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace imgmesh {
namespace {

double rms(double squares, std::int64_t pixels) {
    return pixels == 0 ? 0 : std::sqrt(squares / static_cast<double>(pixels));
}

}  // namespace

bool comes_before(const TileName& a, const TileName& b) {
    return std::tie(a.level, a.row, a.column) < std::tie(b.level, b.row, b.column);
}

TileTotals level_totals(const TileSetIndex& index, int level) {
    TileTotals totals;
    double map = 0, gouraud = 0, seams = 0;
    for (const TileRecord& tile : index.tiles) {
        if (tile.tile.level != level) continue;
        ++totals.tiles;
        totals.vertices += tile.vertices;
        totals.own_vertices += tile.own_vertices;
        totals.faces += tile.faces;
        totals.pixels += tile.pixels;
        totals.seam_pixels += tile.seam_pixels;
        for (const TileFile& file : tile.files) totals.bytes += file.bytes;
        map += tile.map_squares;
        gouraud += tile.gouraud_squares;
        seams += tile.seam_squares;
    }
    totals.map_rms = rms(map, totals.pixels);
    totals.gouraud_rms = rms(gouraud, totals.pixels);
    totals.seam_rms = rms(seams, totals.seam_pixels);
    return totals;
}

const TileRecord* find_tile(const TileSetIndex& index, const TileName& tile) {
    const auto at = std::lower_bound(
        index.tiles.begin(), index.tiles.end(), tile,
        [](const TileRecord& record, const TileName& name) { return comes_before(record.tile, name); });
    return at != index.tiles.end() && at->tile == tile ? &*at : nullptr;
}

}  // namespace imgmesh
