#include "libcore/refine/vertex_tiles.h"

#include <algorithm>

#include "libcore/mesh/vertex_coloring.h"

namespace imgmesh {
namespace {

// Pixels along a side. The image and the faces of a tile fit the second-level cache.
constexpr int kTile = 64;

}  // namespace

VertexTiles::VertexTiles(std::span<const Face> faces, std::span<const Vec2f> position) {
    const auto index = [](float at) { return static_cast<Id>(std::max(0.0f, at)) / kTile; };
    Id columns = 1, rows = 1;
    for (const Vec2f& p : position) {
        columns = std::max(columns, index(p.x()) + 1);
        rows = std::max(rows, index(p.y()) + 1);
    }
    const auto tile_of = [&](Id v) { return index(position[v].y()) * columns + index(position[v].x()); };
    std::vector<bool> used(position.size(), false);
    std::vector<Face> neighbors;  // tiles that share a face
    for (const auto& [a, b, c] : faces) {
        if (a == kNone) continue;
        used[a] = used[b] = used[c] = true;
        neighbors.push_back({tile_of(a), tile_of(b), tile_of(c)});
    }
    members_.resize(std::size_t{columns} * rows);
    for (Id v = 0; v < position.size(); ++v)
        if (used[v]) members_[tile_of(v)].push_back(v);
    classes_ = vertex_coloring(neighbors, members_.size());
}

}  // namespace imgmesh
