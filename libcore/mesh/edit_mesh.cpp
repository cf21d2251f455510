#include "libcore/mesh/edit_mesh.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace imgmesh {

EditMesh::EditMesh(std::vector<Face> faces, std::size_t vertices)
    : faces_(std::move(faces)), next_(faces_.size()), first_(vertices, kNone) {
    for (std::size_t f = faces_.size(); f-- > 0;) attach(static_cast<Id>(f));
    live_vertices_ = vertices - static_cast<std::size_t>(std::count(first_.begin(), first_.end(), kNone));
}

Id& EditMesh::link_to(Id f, Id v) {
    Id* link = &first_[v];
    while (*link != f) link = &next_[*link][corner_of(faces_[*link], v)];
    return *link;
}

void EditMesh::attach(Id f) {
    for (std::size_t i = 0; i < 3; ++i) next_[f][i] = std::exchange(first_[faces_[f][i]], f);
}

void EditMesh::detach(Id f) {
    for (std::size_t i = 0; i < 3; ++i) link_to(f, faces_[f][i]) = next_[f][i];
}

void EditMesh::begin_ring(Id v, Id f) {
    Id& own = next_[f][corner_of(faces_[f], v)];
    link_to(f, v) = own;
    own = std::exchange(first_[v], f);
}

Id EditMesh::add_face(const Face& face) {
    if (last_hole_ == kNone) {
        faces_.push_back(face);
        next_.push_back({kNone, kNone, kNone});
        return static_cast<Id>(faces_.size() - 1);
    }
    const Id f = std::exchange(last_hole_, next_[last_hole_][0]);
    faces_[f] = face;
    return f;
}

Id EditMesh::add_vertex() {
    ++live_vertices_;
    if (free_vertices_.empty()) {
        first_.push_back(kNone);
        return static_cast<Id>(first_.size() - 1);
    }
    const Id v = free_vertices_.back();
    free_vertices_.pop_back();
    return v;
}

Id EditMesh::find_face(Id a, Id b, Id c) const {
    for (Id f = first_[a]; f != kNone; f = next(f, a)) {
        const std::size_t i = corner_of(faces_[f], a);
        if (faces_[f][(i + 1) % 3] == b && faces_[f][(i + 2) % 3] == c) return f;
    }
    return kNone;
}

Id EditMesh::across(Id f, std::size_t i) const {
    // f has the edge from a to b, its neighbour the one from b to a.
    const Id a = faces_[f][(i + 1) % 3], b = faces_[f][(i + 2) % 3];
    for (Id g = first_[a]; g != kNone;) {
        const std::size_t at = corner_of(faces_[g], a);
        if (faces_[g][at == 0 ? 2 : at - 1] == b) return g;
        g = next_[g][at];
    }
    return kNone;
}

Id EditMesh::apex(Id f, Id g) const {
    const auto [a, b, c] = faces_[f];
    const Face& other = faces_[g];
    const auto shared = [&](Id v) { return v == other[0] || v == other[1] || v == other[2]; };
    return !shared(a) ? a : !shared(b) ? b : c;
}

bool EditMesh::ring(Id v, OneRing& out) const {
    // Face k leads from the ring vertex k to this one.
    std::array<Id, OneRing::kMaxFaces> to;
    std::size_t n = 0;
    for (Id f = first_[v]; f != kNone; ++n) {
        if (n == to.size()) return false;
        const Face& face = faces_[f];
        const std::size_t i = corner_of(face, v);
        out.face[n] = f;
        out.corner[n] = static_cast<std::uint8_t>(i);
        out.vertex[n] = face[i == 2 ? 0 : i + 1];
        to[n] = face[i == 0 ? 2 : i - 1];
        f = next_[f][i];
    }
    if (n == 0) return false;
    const auto exchange = [&](std::size_t k, std::size_t m) {
        std::swap(out.face[k], out.face[m]);
        std::swap(out.corner[k], out.corner[m]);
        std::swap(out.vertex[k], out.vertex[m]);
        std::swap(to[k], to[m]);
    };
    // Puts faces that follow the first one in order behind it; returns how many are in order then.
    const auto put_in_order = [&] {
        std::size_t k = 1;
        for (; k < n; ++k) {
            std::size_t m = k;
            while (m < n && out.vertex[m] != to[k - 1]) ++m;
            if (m == n) break;
            if (m != k) exchange(k, m);
        }
        return k;
    };
    out.center = v;
    out.faces = put_in_order();
    out.closed = to[out.faces - 1] == out.vertex[0];
    if (!out.closed) {
        // Back to the border.
        for (std::size_t m = 0; m < n;) {
            if (to[m] == out.vertex[0]) {
                exchange(0, m);
                m = 0;
            } else {
                ++m;
            }
        }
        out.faces = put_in_order();
    }
    out.vertex[out.faces] = to[out.faces - 1];
    return true;
}

bool EditMesh::may_flip(Id f, std::size_t i) const {
    const Id g = across(f, i);
    if (g == kNone) return false;
    const Id p = faces_[f][i], q = apex(g, f);
    const auto has_room = [&](Id v, Id other) {
        std::size_t faces = 0;
        for (Id h = first_[v]; h != kNone; h = next(h, v), ++faces)
            if (std::find(faces_[h].begin(), faces_[h].end(), other) != faces_[h].end()) return false;
        return faces < OneRing::kMaxFaces;
    };
    return has_room(p, q) && has_room(q, p);
}

void EditMesh::flip(Id f, std::size_t i) {
    const Id g = across(f, i);
    assert(g != kNone);
    const Id p = faces_[f][i], a = faces_[f][(i + 1) % 3], b = faces_[f][(i + 2) % 3];
    const Id q = apex(g, f);
    detach(f);
    detach(g);
    faces_[f] = {p, a, q};
    faces_[g] = {q, b, p};
    attach(g);
    attach(f);
}

Id EditMesh::split_face(Id f) {
    const auto [a, b, c] = faces_[f];
    detach(f);
    const Id v = add_vertex(), g = add_face({v, b, c}), h = add_face({v, c, a});
    faces_[f] = {v, a, b};
    for (const Id face : {h, g, f}) attach(face);
    return v;
}

Id EditMesh::split_edge(Id f, std::size_t i) {
    const Id g = across(f, i);
    const Id o = faces_[f][i], a = faces_[f][(i + 1) % 3], b = faces_[f][(i + 2) % 3];
    const Id q = g == kNone ? kNone : apex(g, f);
    detach(f);
    const Id v = add_vertex(), f2 = add_face({v, b, o});
    faces_[f] = {v, o, a};
    if (g != kNone) {
        detach(g);
        const Id g2 = add_face({v, a, q});
        faces_[g] = {v, q, b};
        attach(g2);
        attach(g);
    }
    attach(f2);
    attach(f);
    return v;
}

bool EditMesh::may_collapse(const OneRing& removed, Id kept) const {
    OneRing other;
    if (removed.find(kept) < 0 || !ring(kept, other)) return false;
    std::size_t at_edge = 0, common = 0;
    for (std::size_t k = 0; k < removed.faces; ++k) at_edge += removed.has(k, kept);
    for (std::size_t k = 0; k < removed.vertices(); ++k) common += other.find(removed.vertex[k]) >= 0;
    if (common != at_edge || (!removed.closed && !other.closed && at_edge == 2)) return false;
    const std::size_t faces = removed.faces + other.faces - 2 * at_edge;
    return faces >= (removed.closed && other.closed ? 3u : 1u) && faces <= OneRing::kMaxFaces;
}

void EditMesh::collapse(const OneRing& removed, Id kept) {
    for (std::size_t k = 0; k < removed.faces; ++k) {
        if (!removed.has(k, kept)) continue;
        const Id f = removed.face[k];
        detach(f);
        faces_[f] = {kNone, kNone, kNone};
        next_[f][0] = std::exchange(last_hole_, f);
    }
    Id f = std::exchange(first_[removed.center], kNone);
    link_to(kNone, kept) = f;
    while (f != kNone) {
        const std::size_t i = corner_of(faces_[f], removed.center);
        faces_[f][i] = kept;
        f = next_[f][i];
    }
    free_vertices_.push_back(removed.center);
    --live_vertices_;
}

}  // namespace imgmesh
