#include "formats/picture/regions/list_coverage.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "libcore/base/error.h"

namespace imgmesh {

void guess_sizes(TileList& list) {
    std::map<int, std::set<int>> of_row, of_column;  // the x of each y, and the y of each x
    for (const ListedTile& tile : list.tiles) {
        of_row[tile.y].insert(tile.x);
        of_column[tile.x].insert(tile.y);
    }
    const auto reach = [](const std::set<int>& places, int from, int end) {
        const auto next = places.upper_bound(from);
        return (next == places.end() ? end : *next) - from;
    };
    for (ListedTile& tile : list.tiles) {
        if (tile.width == 0) tile.width = reach(of_row[tile.y], tile.x, list.width);
        if (tile.height == 0) tile.height = reach(of_column[tile.x], tile.y, list.height);
    }
}

void check_coverage(const std::string& path, const TileList& list) {
    std::vector<int> edges;  // between which the same tiles are met
    for (const ListedTile& tile : list.tiles) {
        if (tile.width < 1 || tile.height < 1 || tile.width > list.width - tile.x ||
            tile.height > list.height - tile.y)
            throw Error(
                ErrorKind::kBadFile,
                cat(path, ": ", tile.path, " of ", tile.width, "x", tile.height, " pixels at (", tile.x, ", ",
                    tile.y, ") is not inside the picture of ", list.width, "x", list.height));
        edges.push_back(tile.y);
        edges.push_back(tile.y + tile.height);
    }
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<std::size_t> order(list.tiles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {},
                             [&](std::size_t i) { return std::pair(list.tiles[i].y, list.tiles[i].x); });
    const auto gap = [&](int x, int y) {
        return Error(ErrorKind::kBadFile, cat(path, ": no file has pixel (", x, ", ", y, ") of the picture"));
    };
    if (edges.front() > 0) throw gap(0, 0);
    if (edges.back() < list.height) throw gap(0, edges.back());
    std::vector<std::size_t> met;
    std::size_t next = 0;
    for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
        const int y = edges[e];
        std::erase_if(met, [&](std::size_t i) { return list.tiles[i].y + list.tiles[i].height <= y; });
        for (; next < order.size() && list.tiles[order[next]].y <= y; ++next) met.push_back(order[next]);
        std::ranges::stable_sort(met, {}, [&](std::size_t i) { return list.tiles[i].x; });
        int covered = 0;
        for (const std::size_t i : met) {
            if (list.tiles[i].x > covered) break;
            covered = std::max(covered, list.tiles[i].x + list.tiles[i].width);
        }
        if (covered < list.width) throw gap(covered, y);
    }
}

}  // namespace imgmesh
