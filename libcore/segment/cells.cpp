#include "libcore/segment/cells.h"

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/grid_neighbors.h"

namespace imgmesh {

Cells cut_cells(const PixelMap& map) {
    DisjointSets sets(map.size());
    for_neighbor_pixels(map, [&](std::size_t i, std::size_t j) {
        if (map[i].face == map[j].face && map[i].face != kNone) sets.join(as_id(i), as_id(j));
    });
    Cells cells(map, kNone);
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (map[i].face == kNone) continue;
        const Id first = sets.find(as_id(i));
        if (first == i) {
            cells[i] = as_id(cells.count());
            cells.face.push_back(map[i].face);
        } else {
            cells[i] = cells[first];
        }
    }
    return cells;
}

}  // namespace imgmesh
