// The seams are a shortest spanning tree of the boundary loops: shortest ways from all loops at once
// (Dijkstra, "A note on two problems in connexion with graphs", 1959), then the edges between the loops'
// surroundings in ascending order (Kruskal, "On the shortest spanning subtree of a graph", 1956).
#include "libcore/mesh/disc_parts.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// Sets that can be united; each is named by its lowest element.
class Sets {
  public:
    explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
    std::size_t find(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    bool unite(std::size_t a, std::size_t b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

  private:
    std::vector<std::size_t> parent_;
};

using Edge = std::pair<Id, Id>;  // the lower vertex first

Edge edge_of(Id a, Id b) {
    return {std::min(a, b), std::max(a, b)};
}

// The side of a face from its corner `corner` % 3 to the next one; a corner is 3 * face + place.
struct Side {
    Edge edge;
    std::size_t corner;
};

std::size_t next_corner(std::size_t corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

struct Sides {
    std::vector<Side> boundary;                   // those with one face
    std::vector<std::pair<Side, Side>> interior;  // both sides of an edge
};

Sides sides_of(const std::vector<Face>& faces) {
    std::vector<Side> all;
    all.reserve(3 * faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            all.push_back({edge_of(faces[f][k], faces[f][(k + 1) % 3]), 3 * f + k});
    std::sort(all.begin(), all.end(), [](const Side& a, const Side& b) {
        return std::tie(a.edge, a.corner) < std::tie(b.edge, b.corner);
    });
    Sides out;
    for (std::size_t i = 0; i < all.size();) {
        const bool paired = i + 1 < all.size() && all[i].edge == all[i + 1].edge;
        if (paired)
            out.interior.emplace_back(all[i], all[i + 1]);
        else
            out.boundary.push_back(all[i]);
        i += paired ? 2 : 1;
    }
    return out;
}

// Faces whose vertices have been copied: `origin` has for each vertex the one that it is a copy of.
struct Split {
    std::vector<Face> faces;
    std::vector<Id> origin;
};

// Gives faces around a vertex one copy of it only where they hang together by edges that are not in `cuts`,
// which are in ascending order.
Split split_at(const Split& from, const std::vector<Edge>& cuts) {
    Sets corners(3 * from.faces.size());
    for (const auto& [a, b] : sides_of(from.faces).interior) {
        if (std::binary_search(cuts.begin(), cuts.end(), a.edge)) continue;
        corners.unite(a.corner, next_corner(b.corner));
        corners.unite(next_corner(a.corner), b.corner);
    }
    std::vector<std::pair<Id, std::size_t>> copies;  // the vertex, and the lowest corner of the copy
    const auto vertex_at = [&](std::size_t corner) { return from.faces[corner / 3][corner % 3]; };
    for (std::size_t c = 0; c < 3 * from.faces.size(); ++c)
        if (corners.find(c) == c) copies.emplace_back(vertex_at(c), c);
    std::sort(copies.begin(), copies.end());
    std::vector<Id> name(3 * from.faces.size(), kNone);
    Split out{from.faces, {}};
    for (const auto& [vertex, corner] : copies) {
        name[corner] = as_id(out.origin.size());
        out.origin.push_back(from.origin[vertex]);
    }
    for (std::size_t c = 0; c < 3 * from.faces.size(); ++c) out.faces[c / 3][c % 3] = name[corners.find(c)];
    return out;
}

// Where each vertex's side of the boundary ends; kNone inside. Every vertex has at most one, after
// split_at().
std::vector<Id> boundary_steps(const Split& mesh) {
    std::vector<Id> to(mesh.origin.size(), kNone);
    for (const Side& side : sides_of(mesh.faces).boundary) {
        const std::size_t end = next_corner(side.corner);
        to[mesh.faces[side.corner / 3][side.corner % 3]] = mesh.faces[end / 3][end % 3];
    }
    return to;
}

struct Way {
    double length = std::numeric_limits<double>::infinity();
    Id back = kNone;  // the vertex before, towards the loop
    std::size_t loop = 0;
};

// Returns the shortest way from the boundary to each vertex.
std::vector<Way> ways_from_loops(const std::vector<Vec2f>& position, const std::vector<Edge>& edges,
                                 const std::vector<Id>& step) {
    std::vector<Way> ways(position.size());
    std::vector<std::size_t> first(position.size() + 1, 0);
    std::vector<Id> beside(2 * edges.size());
    for (const auto& [a, b] : edges) {
        ++first[a + 1];
        ++first[b + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::size_t> at(first.begin(), first.end() - 1);
    for (const auto& [a, b] : edges) {
        beside[at[a]++] = b;
        beside[at[b]++] = a;
    }
    using Entry = std::pair<double, Id>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::size_t loops = 0;
    for (Id start = 0; start < step.size(); ++start) {
        if (step[start] == kNone || ways[start].length == 0) continue;
        for (Id v = start; ways[v].length != 0; v = step[v]) {
            ways[v] = {0, kNone, loops};
            queue.emplace(0, v);
        }
        ++loops;
    }
    while (!queue.empty()) {
        const auto [length, v] = queue.top();
        queue.pop();
        if (length > ways[v].length) continue;
        for (std::size_t i = first[v]; i < first[v + 1]; ++i) {
            const Id w = beside[i];
            const double longer = length + static_cast<double>((position[w] - position[v]).norm());
            if (longer >= ways[w].length) continue;
            ways[w] = {longer, v, ways[v].loop};
            queue.emplace(longer, w);
        }
    }
    return ways;
}

// Returns the edges of the seams, in ascending order.
std::vector<Edge> seams(const Split& mesh, const std::vector<Vec2f>& position) {
    std::vector<Edge> inner;
    for (const auto& [side, other] : sides_of(mesh.faces).interior) inner.push_back(side.edge);
    const std::vector<Id> step = boundary_steps(mesh);
    const std::vector<Way> ways = ways_from_loops(position, inner, step);
    std::vector<std::tuple<double, Id, Id>> bridges;
    for (const auto& [a, b] : inner)
        if (ways[a].loop != ways[b].loop)
            bridges.emplace_back(
                ways[a].length + ways[b].length + static_cast<double>((position[a] - position[b]).norm()), a,
                b);
    std::sort(bridges.begin(), bridges.end());
    Sets joined(step.size());  // at most as many loops as vertices
    std::vector<Edge> cuts;
    for (const auto& [length, a, b] : bridges) {
        if (!joined.unite(ways[a].loop, ways[b].loop)) continue;
        cuts.push_back(edge_of(a, b));
        for (Id v : {a, b})
            for (; ways[v].back != kNone; v = ways[v].back) cuts.push_back(edge_of(v, ways[v].back));
    }
    std::sort(cuts.begin(), cuts.end());
    return cuts;
}

}  // namespace

std::vector<DiscPart> disc_parts(const BaseMesh& mesh) {
    Split whole{mesh.faces, std::vector<Id>(mesh.vertex_count())};
    std::iota(whole.origin.begin(), whole.origin.end(), Id{0});
    const Split fans = split_at(whole, {});
    std::vector<Vec2f> position;
    for (const Id v : fans.origin) position.push_back(mesh.position[v]);
    const Split discs = split_at(fans, seams(fans, position));

    // Parts, numbered by their first faces.
    Sets sets(discs.faces.size());
    for (const auto& [a, b] : sides_of(discs.faces).interior) sets.unite(a.corner / 3, b.corner / 3);
    std::vector<DiscPart> parts;
    std::vector<std::size_t> part_of_face(discs.faces.size()), part_of_vertex(discs.origin.size());
    for (std::size_t f = 0; f < discs.faces.size(); ++f) {
        const std::size_t first = sets.find(f);
        if (first == f) parts.emplace_back();
        part_of_face[f] = first == f ? parts.size() - 1 : part_of_face[first];
        for (const Id v : discs.faces[f]) part_of_vertex[v] = part_of_face[f];
    }
    std::vector<Id> name(discs.origin.size(), kNone);
    const auto add = [&](DiscPart& part, Id v) {
        name[v] = as_id(part.vertex.size());
        part.vertex.push_back(discs.origin[v]);
    };
    const std::vector<Id> step = boundary_steps(discs);
    for (Id start = 0; start < step.size(); ++start) {
        if (step[start] == kNone || name[start] != kNone) continue;
        DiscPart& part = parts[part_of_vertex[start]];
        if (part.hull > 0) throw Error(ErrorKind::kInternal, "a part of the mesh has a hole without a seam");
        for (Id v = start; name[v] == kNone; v = step[v]) add(part, v);
        part.hull = part.vertex.size();
    }
    for (Id v = 0; v < step.size(); ++v)
        if (name[v] == kNone) add(parts[part_of_vertex[v]], v);
    for (std::size_t f = 0; f < discs.faces.size(); ++f) {
        const auto& [a, b, c] = discs.faces[f];
        parts[part_of_face[f]].faces.push_back({name[a], name[b], name[c]});
    }
    // Euler's formula for a disc, whose edges are (3 F + hull) / 2.
    for (const DiscPart& part : parts)
        if (part.hull == 0 || 2 * part.vertex.size() != part.faces.size() + part.hull + 2)
            throw Error(ErrorKind::kInternal, "a part of the mesh is no disc");
    return parts;
}

}  // namespace imgmesh
