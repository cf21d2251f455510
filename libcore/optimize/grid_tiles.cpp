#include "libcore/optimize/grid_tiles.h"

#include <algorithm>
#include <utility>

#include "libcore/base/index.h"

namespace imgmesh {

GridTiles::GridTiles(std::span<const Face> faces, std::size_t vertices)
    : vertices_(as_id(vertices)), tiles_((vertices_ + kTileVertices - 1) / kTileVertices) {
    // Of each tile: itself, and the tiles that share a face with it.
    std::vector<std::vector<Id>> near(tiles_);
    for (Id tile = 0; tile < tiles_; ++tile) near[tile].push_back(tile);
    const auto connect = [&](Id from, Id to) {
        if (std::find(near[from].begin(), near[from].end(), to) == near[from].end()) near[from].push_back(to);
    };
    for (const auto& [a, b, c] : faces) {
        if (a == kNone) continue;
        const Id of_a = a / kTileVertices, of_b = b / kTileVertices, of_c = c / kTileVertices;
        if (of_a == of_b && of_b == of_c) continue;
        for (const auto& [from, to] : {std::pair(of_a, of_b), {of_b, of_c}, {of_c, of_a}}) {
            connect(from, to);
            connect(to, from);
        }
    }
    // Each tile joins the first class where nobody claims what it claims.
    for (Id tile = 0; tile < tiles_; ++tile) {
        const auto open = std::find_if(classes_.begin(), classes_.end(), [&](const Class& turns) {
            return std::all_of(near[tile].begin(), near[tile].end(),
                               [&](Id claimed) { return turns.claims[claimed] == kNone; });
        });
        Class& turns =
            open != classes_.end() ? *open : classes_.emplace_back(Class{{}, std::vector<Id>(tiles_, kNone)});
        turns.tiles.push_back(tile);
        for (const Id claimed : near[tile]) turns.claims[claimed] = tile;
    }
}

}  // namespace imgmesh
