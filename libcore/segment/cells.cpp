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
    const auto width = static_cast<std::size_t>(map.width);
    // A forest over the pixels. Each root is the first pixel of its cell.
    std::vector<Id> parent(map.coords.size());
    std::iota(parent.begin(), parent.end(), Id{0});
    const auto join = [&](std::size_t i, std::size_t j) {
        if (map.coords[i].face != map.coords[j].face || map.coords[i].face == kNone) return;
        const Id a = root_of(parent, static_cast<Id>(i)), b = root_of(parent, static_cast<Id>(j));
        parent[std::max(a, b)] = std::min(a, b);
    };
    for (std::size_t i = 0; i < map.coords.size(); ++i) {
        if (i % width != 0) join(i - 1, i);
        if (i >= width) join(i - width, i);
    }
    Cells cells{map.width, map.height, std::vector<Id>(map.coords.size(), kNone), {}};
    for (std::size_t i = 0; i < map.coords.size(); ++i) {
        if (map.coords[i].face == kNone) continue;
        const Id root = root_of(parent, static_cast<Id>(i));
        if (root == i) {
            cells.of_pixel[i] = static_cast<Id>(cells.count());
            cells.face.push_back(map.coords[i].face);
        } else {
            cells.of_pixel[i] = cells.of_pixel[root];
        }
    }
    return cells;
}

}  // namespace imgmesh
