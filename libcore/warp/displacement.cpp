#include "libcore/warp/displacement.h"

#include <algorithm>

#include "libcore/base/parallel.h"
#include "libcore/mesh/grid_area.h"
#include "libcore/warp/cover.h"
#include "libcore/warp/ordered_mesh.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 64;

// The moves of a face's corners: that of the first, and the differences of the other two from it.
struct FaceMove {
    float x = 0, y = 0, ux = 0, uy = 0, vx = 0, vy = 0;
};

// What a level adds. Only faces that move cost more than a look at a byte.
struct LevelMove {
    std::vector<FaceMove> face;
    std::vector<std::uint8_t> first;  // which corner FaceMove begins with, or kStill
};
constexpr std::uint8_t kStill = 3;

// Returns the corner of a face to begin with. Containers rotate corners, and sums round differently in
// another order.
std::uint8_t first_corner(const BaseMesh& mesh, const Face& face) {
    std::uint8_t first = 0;
    for (const std::uint8_t k : {std::uint8_t{1}, std::uint8_t{2}})
        if (is_above(mesh.position[face[k]], mesh.position[face[first]])) first = k;
    return first;
}

LevelMove level_move(const BaseMesh& mesh, const VertexMoves& moves) {
    LevelMove level{std::vector<FaceMove>(mesh.faces.size()), std::vector<std::uint8_t>(mesh.faces.size())};
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Face& face = mesh.faces[f];
        const std::uint8_t first = first_corner(mesh, face);
        const Vec2f &a = moves[face[first]], &b = moves[face[(first + 1u) % 3]],
                    &c = moves[face[(first + 2u) % 3]];
        level.face[f] = {a.x(), a.y(), b.x() - a.x(), b.y() - a.y(), c.x() - a.x(), c.y() - a.y()};
        level.first[f] = a.isZero(0) && b.isZero(0) && c.isZero(0) ? kStill : first;
    }
    return level;
}

// A weight of 1 for a corner must give exactly its move, and so must three equal corners. If moves differ
// only by rounding, the difference below is a rounding of that difference.
void add_row(const LevelMove& level, std::span<const PixelCoord> coords, Vec2f* out) {
    for (std::size_t x = 0; x < coords.size(); ++x) {
        const PixelCoord& c = coords[x];
        if (c.face == kNone || level.first[c.face] == kStill) continue;
        const FaceMove& m = level.face[c.face];
        const std::uint8_t first = level.first[c.face];
        const float w = 1 - c.u - c.v;  // exact where weights are multiples of a step, as in pixel maps
        const float u = first == 0 ? c.u : first == 1 ? c.v : w, v = first == 0 ? c.v : first == 1 ? w : c.u;
        out[x].x() += m.x + u * m.ux + v * m.vx;
        out[x].y() += m.y + u * m.uy + v * m.vy;
    }
}

// Calls visit(neighbour) for the neighbours of pixel i, in ascending order.
template <typename Visit>
void for_neighbors(const DisplacementField& field, std::size_t i, const Visit& visit) {
    const int x = field.x_of(i), y = field.y_of(i);
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, field.height - 1); ++ny)
        for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, field.width - 1); ++nx)
            if (nx != x || ny != y) visit(field.index(nx, ny));
}

// Returns the outside pixels beside any of `sources`, ascending.
std::vector<std::size_t> outside_beside(const DisplacementField& field,
                                        const std::vector<std::size_t>& sources) {
    std::vector<std::size_t> found;
    for (const std::size_t i : sources)
        for_neighbors(field, i, [&](std::size_t n) {
            if (field.role[n] == PixelRole::kOutside) found.push_back(n);
        });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

// Calls visit(pixel) for the top left pixel of each cell that is turned over, in ascending order.
template <typename Visit>
void for_folded_cells(const DisplacementField& field, const Visit& visit) {
    const auto at = [&](int x, int y) {
        return Vec2d(Vec2d(x, y) + field.move[field.index(x, y)].cast<double>());
    };
    const auto inside = [&](int x, int y) { return field.role[field.index(x, y)] == PixelRole::kInside; };
    for (int y = 0; y + 1 < field.height; ++y)
        for (int x = 0; x + 1 < field.width; ++x) {
            if (!inside(x, y) || !inside(x + 1, y) || !inside(x, y + 1) || !inside(x + 1, y + 1)) continue;
            const Vec2d a = at(x, y), b = at(x + 1, y), c = at(x, y + 1), d = at(x + 1, y + 1);
            if (!(grid_area2(a, b, d) > 0 && grid_area2(a, d, c) > 0)) visit(field.index(x, y));
        }
}

// A level that moves, and the map through which its pixels do.
struct MovedLevel {
    LevelMove move;
    const PixelMap* map;
};

DisplacementField field_of(const MeshImage& mesh_image, const std::vector<MovedLevel>& levels) {
    const SourceInfo& source = mesh_image.source;
    DisplacementField field{source, std::vector<Vec2f>(source.pixel_count(), Vec2f(0, 0)),
                            std::vector<PixelRole>(source.pixel_count(), PixelRole::kInside),
                            source.has_mask};
    parallel_blocks(0, field.height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y) {
            for (const MovedLevel& level : levels)
                add_row(level.move, level.map->row(y), field.move.data() + field.row_begin(y));
            if (!field.has_mask) continue;
            PixelRole* role = field.role.data() + field.row_begin(y);
            for (const PixelCoord& c : mesh_image.levels[0].map.row(y))
                *role++ = c.face == kNone ? PixelRole::kOutside : PixelRole::kInside;
        }
    });
    return field;
}

}  // namespace

DisplacementField displacement_field(const MeshImage& mesh_image, const std::vector<VertexMoves>& moves) {
    std::vector<MovedLevel> levels;
    for (std::size_t k = 0; k < moves.size(); ++k)
        if (!moves[k].empty())
            levels.push_back({level_move(mesh_image.levels[k].mesh, moves[k]), &mesh_image.levels[k].map});
    return field_of(mesh_image, levels);
}

DisplacementField edit_field(const MeshImage& mesh_image, const EditSolution& solution) {
    std::vector<MovedLevel> levels;
    std::vector<PixelMap> by_place(solution.moves.size());
    for (std::size_t k = 0; k < solution.moves.size(); ++k) {
        const VertexMoves& moves = solution.moves[k];
        const Level& level = mesh_image.levels[k];
        if (moves.empty()) continue;
        if (!solution.injective[k]) {
            levels.push_back({level_move(level.mesh, moves), &level.map});
            continue;
        }
        const OrderedMesh ordered = ordered_mesh(level.mesh);
        VertexMoves renamed(moves.size());
        for (std::size_t v = 0; v < moves.size(); ++v) renamed[ordered.rank[v]] = moves[v];
        by_place[k] = map_by_place(ordered.mesh, level.map);
        levels.push_back({level_move(ordered.mesh, renamed), &by_place[k]});
    }
    return field_of(mesh_image, levels);
}

void extend_outside(DisplacementField& field, std::vector<float>& alpha) {
    if (!field.has_mask) return;
    std::vector<std::size_t> sources;
    for (std::size_t i = 0; i < field.role.size(); ++i) {
        if (field.role[i] == PixelRole::kOutside) continue;
        bool beside = false;
        for_neighbors(field, i, [&](std::size_t n) { beside |= field.role[n] == PixelRole::kOutside; });
        if (beside) sources.push_back(i);
    }
    while (!sources.empty()) {
        const std::vector<std::size_t> ring = outside_beside(field, sources);
        for (const std::size_t i : ring) {
            Vec2f sum(0, 0);
            float count = 0;
            for_neighbors(field, i, [&](std::size_t n) {
                if (field.role[n] != PixelRole::kInside) return;
                sum += field.move[n];
                count += 1;
            });
            field.move[i] = sum / count;
        }
        sources.clear();
        for (const std::size_t i : ring) {
            const bool soft = !alpha.empty() && alpha[i] > 0 && alpha[i] < 1;
            field.role[i] = soft ? PixelRole::kInside : PixelRole::kGhost;
            if (soft) sources.push_back(i);
        }
    }
    alpha.resize(field.role.size(), 1.0f);
    for (std::size_t i = 0; i < alpha.size(); ++i)
        if (field.role[i] != PixelRole::kInside) alpha[i] = 0;
}

std::int64_t folded_cells(const DisplacementField& field) {
    std::int64_t folded = 0;
    for_folded_cells(field, [&](std::size_t) { ++folded; });
    return folded;
}

std::vector<std::size_t> list_folded_cells(const DisplacementField& field) {
    std::vector<std::size_t> folded;
    for_folded_cells(field, [&](std::size_t pixel) { folded.push_back(pixel); });
    return folded;
}

}  // namespace imgmesh
