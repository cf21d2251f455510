#include "libcore/coding/color_plan.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "libcore/base/index.h"
#include "libcore/coding/integer_math.h"

namespace imgmesh::coding {
namespace {

// In quarter pixels; areas are doubled.
struct Place {
    std::int64_t x, y;
};
struct Edge {
    Id later, earlier;
    std::int64_t area;  // of its face
};
struct Areas {
    std::vector<std::int64_t> star;  // of each vertex
    std::vector<Edge> edges;         // once for each face
};

Areas areas_of(const CodedShape& shape, const std::vector<Place>& at) {
    Areas out{std::vector<std::int64_t>(at.size()), {}};
    out.edges.reserve(3 * shape.faces.size());
    for (const Face& f : shape.faces) {
        const Place &a = at[f[0]], &b = at[f[1]], &c = at[f[2]];
        const std::int64_t area = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
        for (std::size_t i = 0; i < 3; ++i) {
            const Id from = f[i], to = f[(i + 1) % 3];
            out.star[from] += area;
            out.edges.push_back({std::max(from, to), std::min(from, to), area});
        }
    }
    std::sort(out.edges.begin(), out.edges.end(), [](const Edge& a, const Edge& b) {
        return a.later != b.later       ? a.later < b.later
               : a.earlier != b.earlier ? a.earlier > b.earlier
                                        : a.area < b.area;
    });
    return out;
}

// An error of a colour weighs as much as its star is large: steps are as the inverse root of that, from a
// third of the mesh's step to three times it.
std::vector<std::int32_t> fineness_of(const CodedGrid& grid, const std::vector<std::int64_t>& star) {
    const std::int64_t all = std::int64_t{6} * grid.right() * grid.bottom();
    const std::int64_t mean = all / static_cast<std::int64_t>(star.size());
    std::vector<std::int32_t> out;
    out.reserve(star.size());
    for (const std::int64_t own : star) {
        const std::int64_t ratio = 4096 * mean / std::max<std::int64_t>(own, 1);
        out.push_back(
            static_cast<std::int32_t>(floor_root(4096 * std::clamp<std::int64_t>(ratio, 455, 36864))));
    }
    return out;
}

// 256 log2 of a neighbour's share. Vertices lie close together where colours change: the long edge with wide
// faces to a vertex with a wide star says most. The exponents of squared length, the two faces' area and the
// star's area are .28, .8 and .34, fitted on three pictures (docs/decisions/0044-colours-of-coded-meshes.md).
std::int32_t log_share(std::int64_t squared_length, std::int64_t faces, std::int64_t star) {
    return (18 * log2_of(static_cast<std::uint64_t>(squared_length + 16)) +
            51 * log2_of(static_cast<std::uint64_t>(faces + 8)) +
            22 * log2_of(static_cast<std::uint64_t>(star + 8))) >>
           6;
}

void set_weights(std::span<ColorPlan::Neighbor> of) {
    std::int32_t most = 0;
    for (const ColorPlan::Neighbor& n : of) most = std::max(most, n.weight);
    for (ColorPlan::Neighbor& n : of) n.weight = std::max(half_power(4 * (most - n.weight)) >> 2, 1);
}

}  // namespace

ColorPlan plan_colors(const CodedShape& shape) {
    std::vector<Place> at;
    at.reserve(shape.point.size());
    for (const GridPoint& p : shape.point) at.push_back({shape.grid.x(p[0]), shape.grid.y(p[1])});
    const Areas areas = areas_of(shape, at);
    ColorPlan plan;
    plan.fineness = fineness_of(shape.grid, areas.star);
    plan.first.assign(at.size() + 1, 0);
    const std::vector<Edge>& edges = areas.edges;
    for (std::size_t i = 0; i < edges.size();) {
        const Edge& e = edges[i];
        std::int64_t faces = 0;
        for (; i < edges.size() && edges[i].later == e.later && edges[i].earlier == e.earlier; ++i)
            faces += edges[i].area;
        if (plan.first[e.later + 1] == ColorPlan::kMostNeighbors) continue;
        const std::int64_t x = at[e.later].x - at[e.earlier].x, y = at[e.later].y - at[e.earlier].y;
        plan.neighbors.push_back({e.earlier, log_share(x * x + y * y, faces, areas.star[e.earlier])});
        ++plan.first[e.later + 1];
    }
    for (std::size_t v = 0; v < at.size(); ++v) {
        plan.first[v + 1] += plan.first[v];
        set_weights(std::span(plan.neighbors).subspan(plan.first[v], plan.first[v + 1] - plan.first[v]));
    }
    return plan;
}

}  // namespace imgmesh::coding
