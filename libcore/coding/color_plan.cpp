#include "libcore/coding/color_plan.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <numeric>

#include "libcore/base/index.h"
#include "libcore/coding/integer_math.h"
#include "libcore/optimize/place.h"

namespace imgmesh::coding {
namespace {

// To an earlier vertex, with twice the area of its face.
struct Edge {
    Id earlier;
    std::int64_t area;
};
struct Areas {
    std::vector<std::int64_t> star;    // of each vertex
    std::vector<std::uint32_t> first;  // size V + 1: where the edges to earlier vertices begin
    std::vector<Edge> edges;           // once for each face, the latest earlier vertex first
};

Areas areas_of(const CodedShape& shape, const std::vector<Place>& at) {
    Areas out{std::vector<std::int64_t>(at.size()), std::vector<std::uint32_t>(at.size() + 1), {}};
    for (const Face& f : shape.faces)
        for (std::size_t i = 0; i < 3; ++i) ++out.first[std::max(f[i], f[(i + 1) % 3]) + 1];
    std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
    std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
    out.edges.resize(3 * shape.faces.size());
    for (const Face& f : shape.faces) {
        const Place &a = at[f[0]], &b = at[f[1]], &c = at[f[2]];
        const std::int64_t area = std::abs(area2(a, b, c));
        for (std::size_t i = 0; i < 3; ++i) {
            const Id from = f[i], to = f[(i + 1) % 3];
            out.star[from] += area;
            out.edges[next[std::max(from, to)]++] = {std::min(from, to), area};
        }
    }
    for (std::size_t v = 0; v < at.size(); ++v)
        std::sort(out.edges.begin() + out.first[v], out.edges.begin() + out.first[v + 1],
                  [](const Edge& a, const Edge& b) {
                      return a.earlier != b.earlier ? a.earlier > b.earlier : a.area < b.area;
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
    for (ColorPlan::Neighbor& n : of) {
        const std::int32_t below = most - n.weight;
        n.weight = std::max(half_power(4 * below) >> 2, 1);
        n.flat = std::max(half_power(below) >> 2, 1);
    }
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
    for (std::size_t v = 0; v < at.size(); ++v) {
        const std::size_t begin = plan.neighbors.size();
        for (std::uint32_t i = areas.first[v]; i < areas.first[v + 1];) {
            const Id u = areas.edges[i].earlier;
            std::int64_t faces = 0;
            for (; i < areas.first[v + 1] && areas.edges[i].earlier == u; ++i) faces += areas.edges[i].area;
            if (plan.neighbors.size() - begin == ColorPlan::kMostNeighbors) break;
            const std::int64_t x = at[v].x - at[u].x, y = at[v].y - at[u].y;
            plan.neighbors.push_back({u, log_share(x * x + y * y, faces, areas.star[u]), 0});
        }
        plan.first[v + 1] = static_cast<std::uint32_t>(plan.neighbors.size());
        set_weights(std::span(plan.neighbors).subspan(begin));
    }
    return plan;
}

}  // namespace imgmesh::coding
