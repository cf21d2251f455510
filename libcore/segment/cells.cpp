#include "libcore/segment/cells.h"

#include "libcore/segment/connected_parts.h"

namespace imgmesh {
namespace {

template <typename Alike>
Cells cells_where(const PixelMap& map, const Alike& alike) {
    ConnectedParts parts = connected_parts(
        map, [&](std::size_t i) { return map[i].face != kNone; },
        [&](std::size_t i, std::size_t j) { return map[i].face == map[j].face && alike(i, j); });
    Cells cells(map, kNone);
    cells.values = std::move(parts.part.values);
    for (const std::size_t i : parts.first) cells.face.push_back(map[i].face);
    return cells;
}

}  // namespace

Cells cut_cells(const PixelMap& map) {
    return cells_where(map, [](std::size_t, std::size_t) { return true; });
}

Cells cut_cells(const PixelMap& map, const Grid<Id>& regions) {
    return cells_where(map, [&](std::size_t i, std::size_t j) { return regions[i] == regions[j]; });
}

}  // namespace imgmesh
