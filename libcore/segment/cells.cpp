#include "libcore/segment/cells.h"

#include <numeric>

namespace imgmesh {
namespace {

Id root_of(std::vector<Id>& parent, Id i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

}  // namespace

Cells cut_cells(const PixelMap& map) {
    const std::size_t width = as_index(map.width);
    // A forest over the pixels. Each root is the first pixel of its cell.
    std::vector<Id> parent(map.size());
    std::iota(parent.begin(), parent.end(), Id{0});
    const auto join = [&](std::size_t i, std::size_t j) {
        if (map[i].face != map[j].face || map[i].face == kNone) return;
        const Id a = root_of(parent, as_id(i)), b = root_of(parent, as_id(j));
        parent[std::max(a, b)] = std::min(a, b);
    };
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (i % width != 0) join(i - 1, i);
        if (i >= width) join(i - width, i);
    }
    Cells cells(map, kNone);
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (map[i].face == kNone) continue;
        const Id root = root_of(parent, as_id(i));
        if (root == i) {
            cells[i] = as_id(cells.count());
            cells.face.push_back(map[i].face);
        } else {
            cells[i] = cells[root];
        }
    }
    return cells;
}

}  // namespace imgmesh
