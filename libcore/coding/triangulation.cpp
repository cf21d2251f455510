#include "libcore/coding/triangulation.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace imgmesh::coding {
namespace {

constexpr std::size_t next(std::size_t i) {
    return i == 2 ? 0 : i + 1;
}
constexpr std::size_t before(std::size_t i) {
    return i == 0 ? 2 : i - 1;
}

}  // namespace

bool inside_circle(const Place& a, const Place& b, const Place& c, const Place& d) {
    const std::int64_t ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x,
                       cy = c.y - d.y;
    // Differences below 2^18 make sums below 2^76.
    using Wide = __int128;
    const Wide sum = Wide{ax * ax + ay * ay} * (bx * cy - by * cx) +
                     Wide{bx * bx + by * by} * (cx * ay - cy * ax) +
                     Wide{cx * cx + cy * cy} * (ax * by - ay * bx);
    return sum < 0;
}

Triangulation::Triangulation(std::span<const Place> places, std::span<const Id> order)
    : places_(places), face_of_(places.size(), kNone) {
    Place low = places[0], high = places[0];
    for (const Place& p : places) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const auto at = [&](std::int32_t x, std::int32_t y) {
        for (const Id v : order)
            if (places[v].x == x && places[v].y == y) return v;
        assert(false);
        return kNone;
    };
    const Id a = at(low.x, low.y), b = at(low.x, high.y), c = at(high.x, high.y), d = at(high.x, low.y);
    faces_.reserve(2 * places.size());
    faces_.push_back({{a, b, c}, {kNone, 1, kNone}});
    faces_.push_back({{a, c, d}, {kNone, kNone, 0}});
    face_of_[a] = face_of_[b] = face_of_[c] = 0;
    face_of_[d] = 1;
    Id near = 0;
    for (const Id v : order)
        if (v != a && v != b && v != c && v != d) insert(v, near);
}

Id Triangulation::face_at(Id a, Id b) const {
    // Around a in both directions at once, so that a face near the last one is found soon.
    Id ahead = face_of_[a], behind = ahead;
    const auto corner = [&](Id f) -> std::size_t {
        const auto& c = faces_[f].corner;
        return c[0] == a ? 0 : c[1] == a ? 1 : 2;
    };
    do {
        if (ahead != kNone) {
            const std::size_t i = corner(ahead);
            if (faces_[ahead].corner[next(i)] == b) return ahead;
            ahead = faces_[ahead].across[next(i)];
        }
        if (behind != kNone) {
            const std::size_t i = corner(behind);
            if (faces_[behind].corner[next(i)] == b) return behind;
            behind = faces_[behind].across[before(i)];
        }
    } while ((ahead != kNone || behind != kNone) && ahead != face_of_[a] && behind != face_of_[a]);
    return kNone;
}

std::size_t Triangulation::opposite(Id f, Id a) const {
    const auto& corner = faces_[f].corner;
    return corner[0] == a ? 2 : corner[1] == a ? 0 : 1;
}

std::size_t Triangulation::corner_facing(Id f, Id g) const {
    const auto& across = faces_[f].across;
    return across[0] == g ? 0 : across[1] == g ? 1 : 2;
}

void Triangulation::set_across(Id f, Id g, Id from, Id to) {
    if (g == kNone) return;
    for (std::size_t i = 0; i < 3; ++i)
        if (faces_[g].corner[next(i)] == from && faces_[g].corner[before(i)] == to) faces_[g].across[i] = f;
}

void Triangulation::insert(Id v, Id& near) {
    const Place p = places_[v];
    // Walks towards the place.
    Id f = near;
    std::size_t edge = 3;
    for (bool found = false; !found;) {
        found = true;
        edge = 3;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::int64_t side =
                area2(places_[faces_[f].corner[next(i)]], places_[faces_[f].corner[before(i)]], p);
            if (side == 0) edge = i;
            if (side >= 0) continue;
            f = faces_[f].across[i];
            found = false;
            break;
        }
    }
    std::vector<std::pair<Id, std::size_t>> edges;
    const auto add = [&](Id a, Id b, Id beyond) {  // a new face (v, a, b)
        const auto g = static_cast<Id>(faces_.size());
        faces_.push_back({{v, a, b}, {beyond, kNone, kNone}});
        return g;
    };
    const auto settle = [&](Id g) {
        const auto [o, a, b] = faces_[g].corner;
        set_across(g, faces_[g].across[0], b, a);
        face_of_[o] = face_of_[a] = face_of_[b] = g;
        edges.emplace_back(g, 0);
    };
    const LinkedFace old = faces_[f];
    if (edge == 3) {
        const auto [a, b, c] = old.corner;
        const Id g = add(b, c, old.across[0]), h = add(c, a, old.across[1]);
        faces_[f] = {{v, a, b}, {old.across[2], g, h}};
        faces_[g].across = {old.across[0], h, f};
        faces_[h].across = {old.across[1], f, g};
        for (const Id k : {f, g, h}) settle(k);
    } else {
        // Face (o, a, b), of which v divides the edge (a, b); beyond it (q, b, a).
        const Id o = old.corner[edge], a = old.corner[next(edge)], b = old.corner[before(edge)];
        const Id at_oa = old.across[before(edge)], at_bo = old.across[next(edge)], beyond = old.across[edge];
        const Id g = add(b, o, at_bo);
        faces_[f] = {{v, o, a}, {at_oa, kNone, g}};
        faces_[g].across = {at_bo, f, kNone};
        if (beyond != kNone) {
            const LinkedFace other = faces_[beyond];
            const std::size_t j = other.corner[0] == b ? 2 : other.corner[1] == b ? 0 : 1;
            const Id q = other.corner[j], at_qb = other.across[before(j)], at_aq = other.across[next(j)];
            const Id h = add(a, q, at_aq);
            faces_[beyond] = {{v, q, b}, {at_qb, g, h}};
            faces_[h].across = {at_aq, beyond, f};
            faces_[f].across[1] = h;
            faces_[g].across[2] = beyond;
            settle(beyond);
            settle(h);
        }
        settle(f);
        settle(g);
    }
    legalise(v, edges);
    near = face_of_[v];
}

// Flips edges opposite the new vertex until none has a vertex inside its circle (Lawson 1977).
void Triangulation::legalise(Id v, std::vector<std::pair<Id, std::size_t>>& edges) {
    while (!edges.empty()) {
        const Id f = edges.back().first;
        edges.pop_back();
        const std::size_t i = faces_[f].corner[0] == v ? 0 : faces_[f].corner[1] == v ? 1 : 2;
        const Id g = faces_[f].across[i];
        if (g == kNone) continue;
        const Id a = faces_[f].corner[next(i)], b = faces_[f].corner[before(i)];
        const std::size_t j = opposite(g, b);
        const Id q = faces_[g].corner[j];
        if (!inside_circle(places_[v], places_[a], places_[b], places_[q])) continue;
        const Id at_va = faces_[f].across[before(i)], at_bv = faces_[f].across[next(i)];
        const Id at_qb = faces_[g].across[before(j)], at_aq = faces_[g].across[next(j)];
        faces_[f] = {{v, a, q}, {at_aq, g, at_va}};
        faces_[g] = {{v, q, b}, {at_qb, at_bv, f}};
        set_across(f, at_aq, q, a);
        set_across(g, at_bv, v, b);
        face_of_[v] = face_of_[a] = face_of_[q] = f;
        face_of_[b] = g;
        edges.emplace_back(f, 0);
        edges.emplace_back(g, 0);
    }
}

// The apex of the base (from, to) is the vertex of the chain whose circle with it is empty (Anglada 1997).
void Triangulation::fill(std::span<const Id> chain, Id from, Id to, std::vector<Face>& out) const {
    if (chain.empty()) return;
    std::size_t best = 0;
    for (std::size_t k = 1; k < chain.size(); ++k)
        if (inside_circle(places_[from], places_[to], places_[chain[best]], places_[chain[k]])) best = k;
    out.push_back({from, to, chain[best]});
    fill(chain.first(best), from, chain[best], out);
    fill(chain.subspan(best + 1), chain[best], to, out);
}

void Triangulation::fix_face(Id a, Id b, Id c, std::span<const Id> strip) {
    if (strip.size() == 1) {
        faces_[strip[0]].known = true;
        face_of_[a] = face_of_[b] = face_of_[c] = strip[0];
        return;
    }
    sides_.clear();
    left_.clear();
    right_.clear();
    filled_.assign(1, {a, b, c});
    for (std::size_t k = 0; k < strip.size(); ++k) {
        const LinkedFace& face = faces_[strip[k]];
        for (std::size_t i = 0; i < 3; ++i)
            sides_.push_back({face.corner[next(i)], face.corner[before(i)], face.across[i]});
        if (k + 1 == strip.size()) break;
        // The face after it lies across an edge that the apex makes with one of the last vertices on both
        // sides; the other one is left behind, and the apex takes its place.
        const std::size_t dropped = corner_facing(strip[k], strip[k + 1]);
        const Id apex = face.corner[k == 0 ? opposite(strip[0], a) : corner_facing(strip[k], strip[k - 1])];
        const Id last_left = left_.empty() ? a : left_.back();
        (face.corner[dropped] == last_left ? left_ : right_).push_back(apex);
    }
    std::reverse(right_.begin(), right_.end());
    fill(left_, a, c, filled_);
    fill(right_, c, b, filled_);
    for (std::size_t k = 0; k < strip.size(); ++k) {
        faces_[strip[k]] = {filled_[k], {kNone, kNone, kNone}};
        for (const Id v : filled_[k]) face_of_[v] = strip[k];
    }
    for (std::size_t k = 0; k < strip.size(); ++k)
        for (std::size_t i = 0; i < 3; ++i) {
            const Id from = filled_[k][next(i)], to = filled_[k][before(i)];
            Id across = kNone;
            for (std::size_t m = 0; m < strip.size() && across == kNone; ++m)
                for (std::size_t j = 0; j < 3; ++j)
                    if (filled_[m][next(j)] == to && filled_[m][before(j)] == from) across = strip[m];
            if (across == kNone) {
                for (const Side& side : sides_)
                    if (side.from == from && side.to == to) across = side.face;
                set_across(strip[k], across, to, from);
            }
            faces_[strip[k]].across[i] = across;
        }
    faces_[strip[0]].known = true;
}

}  // namespace imgmesh::coding
