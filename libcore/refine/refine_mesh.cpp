#include "libcore/refine/refine_mesh.h"

#include <algorithm>

#include "libcore/mesh/adjacency.h"

namespace imgmesh {
namespace {

constexpr int next(int i) {
    return i == 2 ? 0 : i + 1;
}
constexpr int previous(int i) {
    return i == 0 ? 2 : i - 1;
}
Id& at(Face& face, int i) {
    return face[static_cast<std::size_t>(i)];
}
Id at(const Face& face, int i) {
    return face[static_cast<std::size_t>(i)];
}
int corner_of(const Face& face, Id v) {
    return face[0] == v ? 0 : face[1] == v ? 1 : 2;
}

}  // namespace

RefineMesh::RefineMesh(const BaseMesh& mesh)
    : position(mesh.position), faces(mesh.faces), across(face_neighbors(mesh)) {
    const std::size_t n = mesh.vertex_count();
    color.reserve(n);
    for (Id v = 0; v < n; ++v) color.emplace_back(mesh.feature_of(v));
    face_of_.assign(n, kNone);
    for (Id f = 0; f < faces.size(); ++f)
        for (const Id v : faces[f]) face_of_[v] = f;
    live_vertices_ = static_cast<std::size_t>(
        std::count_if(face_of_.begin(), face_of_.end(), [](Id f) { return f != kNone; }));

    // An end of a border edge may slide only if each border edge at it lies on one and the same side.
    Vec2f low = position.empty() ? Vec2f(0, 0) : position[0], high = low;
    for (const Vec2f& p : position) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    fixed.assign(n, kFree);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (int i = 0; i < 3; ++i) {
            if (at(across[f], i) != kNone) continue;
            const Id a = at(faces[f], next(i)), b = at(faces[f], previous(i));
            const Vec2f &p = position[a], &q = position[b];
            std::uint8_t axes = kFixed;
            if (p.x() == q.x() && (p.x() == low.x() || p.x() == high.x())) axes = kFixedX;
            if (p.y() == q.y() && (p.y() == low.y() || p.y() == high.y())) axes = kFixedY;
            fixed[a] |= axes;
            fixed[b] |= axes;
        }
}

BaseMesh RefineMesh::compact() const {
    BaseMesh mesh;
    std::vector<Id> number(position.size(), kNone);
    for (Id v = 0; v < position.size(); ++v) {
        if (!live_vertex(v)) continue;
        number[v] = static_cast<Id>(mesh.position.size());
        mesh.position.push_back(position[v]);
        mesh.feature.insert(mesh.feature.end(), color[v].data(), color[v].data() + 3);
    }
    for (Id f = 0; f < faces.size(); ++f)
        if (live_face(f))
            mesh.faces.push_back({number[faces[f][0]], number[faces[f][1]], number[faces[f][2]]});
    return mesh;
}

bool RefineMesh::star(Id v, Star& out) const {
    out.size = 0;
    out.closed = false;
    const Id start = face_of_[v];
    if (start == kNone) return false;
    // Clockwise to the border first, if there is one, then counter-clockwise from there.
    Id f = start;
    for (int turns = 0;; ++turns) {
        const Id before = at(across[f], previous(corner_of(faces[f], v)));
        if (before == kNone) break;
        f = before;
        if (f == start) {
            out.closed = true;
            break;
        }
        if (turns >= Star::kMost) return false;
    }
    const Id first = f;
    do {
        if (out.size == Star::kMost) return false;
        const int i = corner_of(faces[f], v);
        out.face[static_cast<std::size_t>(out.size)] = f;
        out.corner[static_cast<std::size_t>(out.size)] = static_cast<std::uint8_t>(i);
        ++out.size;
        f = at(across[f], next(i));
    } while (f != kNone && f != first);
    return true;
}

int RefineMesh::corner_towards(Id f, Id other) const {
    return across[f][0] == other ? 0 : across[f][1] == other ? 1 : 2;
}

void RefineMesh::link(Id f, int i, Id g) {
    at(across[f], i) = g;
    if (g == kNone) return;
    // The corner of g that is not an end of the shared edge.
    const Id a = at(faces[f], next(i)), b = at(faces[f], previous(i));
    for (int j = 0; j < 3; ++j)
        if (at(faces[g], j) != a && at(faces[g], j) != b) at(across[g], j) = f;
}

Id RefineMesh::new_face(const Face& face) {
    if (free_faces_.empty()) {
        faces.push_back(face);
        across.push_back({kNone, kNone, kNone});
        return static_cast<Id>(faces.size() - 1);
    }
    const Id f = free_faces_.back();
    free_faces_.pop_back();
    faces[f] = face;
    across[f] = {kNone, kNone, kNone};
    return f;
}

Id RefineMesh::new_vertex(const Vec2f& p, const Vec3f& c, std::uint8_t fixed_axes) {
    ++live_vertices_;
    if (free_vertices_.empty()) {
        position.push_back(p);
        color.push_back(c);
        fixed.push_back(fixed_axes);
        face_of_.push_back(kNone);
        return static_cast<Id>(position.size() - 1);
    }
    const Id v = free_vertices_.back();
    free_vertices_.pop_back();
    position[v] = p;
    color[v] = c;
    fixed[v] = fixed_axes;
    return v;
}

void RefineMesh::flip(Id f, int i) {
    const Id g = at(across[f], i);
    const int j = corner_towards(g, f);
    const Id p = at(faces[f], i), a = at(faces[f], next(i)), b = at(faces[f], previous(i));
    const Id q = at(faces[g], j);
    // f = (p, a, b), g = (q, b, a).
    const Id beyond_pa = at(across[f], previous(i)), beyond_pb = at(across[f], next(i));
    const Id beyond_qb = at(across[g], previous(j)), beyond_qa = at(across[g], next(j));
    faces[f] = {p, a, q};
    faces[g] = {q, b, p};
    link(f, 0, beyond_qa);
    link(f, 2, beyond_pa);
    link(g, 0, beyond_pb);
    link(g, 2, beyond_qb);
    across[f][1] = g;
    across[g][1] = f;
    face_of_[p] = face_of_[q] = face_of_[a] = f;
    face_of_[b] = g;
}

Id RefineMesh::split_face(Id f, const Vec2f& p, const Vec3f& c) {
    const auto [a, b, d] = faces[f];
    const auto [beyond_a, beyond_b, beyond_d] = across[f];
    const Id v = new_vertex(p, c, kFree);
    const Id g = new_face({v, b, d}), h = new_face({v, d, a});
    faces[f] = {v, a, b};
    link(f, 0, beyond_d);
    link(g, 0, beyond_a);
    link(h, 0, beyond_b);
    link(f, 1, g);
    link(g, 1, h);
    link(h, 1, f);
    face_of_[v] = face_of_[a] = face_of_[b] = f;
    face_of_[d] = g;
    return v;
}

Id RefineMesh::split_edge(Id f, int i, const Vec2f& p, const Vec3f& c) {
    const Id g = at(across[f], i);
    const Id o = at(faces[f], i), a = at(faces[f], next(i)), b = at(faces[f], previous(i));
    const Id beyond_oa = at(across[f], previous(i)), beyond_ob = at(across[f], next(i));
    const int j = g == kNone ? 0 : corner_towards(g, f);
    const auto side = static_cast<std::uint8_t>(fixed[a] & fixed[b]);
    const Id v = new_vertex(p, c, g == kNone ? side : kFree);
    const Id f2 = new_face({v, b, o});
    faces[f] = {v, o, a};
    face_of_[v] = face_of_[o] = face_of_[a] = f;
    face_of_[b] = f2;
    link(f, 0, beyond_oa);
    link(f2, 0, beyond_ob);
    link(f, 2, f2);  // edge (v, o) is opposite a in f, opposite b in f2
    across[f][1] = kNone;
    across[f2][2] = kNone;
    if (g == kNone) return v;
    // g = (q, b, a): edge (b, a) from the other side.
    const Id q = at(faces[g], j);
    const Id beyond_qb = at(across[g], previous(j)), beyond_qa = at(across[g], next(j));
    const Id g2 = new_face({v, a, q});
    faces[g] = {v, q, b};
    face_of_[q] = g;
    link(g, 0, beyond_qb);
    link(g2, 0, beyond_qa);
    link(g, 2, g2);
    // f = (v, o, a) meets g2 = (v, a, q) at (v, a); f2 = (v, b, o) meets g = (v, q, b) at (v, b).
    link(f, 1, g2);
    link(f2, 2, g);
    return v;
}

void RefineMesh::collapse(const Star& star, Id v, Id u) {
    // The ends of v's star, whose faces vanish, become neighbours' only faces: point them elsewhere first.
    for (int k = 0; k < star.size; ++k) {
        const Id f = star.face[static_cast<std::size_t>(k)];
        if (corner_of(faces[f], u) == 2 && faces[f][2] != u) continue;
        // f = (v, ., .) holds u: the edges opposite v and opposite u close up.
        const int iv = corner_of(faces[f], v), iu = corner_of(faces[f], u), io = 3 - iv - iu;
        const Id o = at(faces[f], io), outer = at(across[f], iv), inner = at(across[f], iu);
        // After the collapse `inner` has the edge (u, o) in place of (v, o).
        if (inner != kNone) at(across[inner], corner_towards(inner, f)) = outer;
        if (outer != kNone) at(across[outer], corner_towards(outer, f)) = inner;
        const Id stays = inner != kNone ? inner : outer;
        face_of_[o] = face_of_[u] = stays;
        faces[f] = {kNone, kNone, kNone};
        free_faces_.push_back(f);
    }
    for (int k = 0; k < star.size; ++k) {
        const Id f = star.face[static_cast<std::size_t>(k)];
        if (!live_face(f)) continue;
        at(faces[f], corner_of(faces[f], v)) = u;
        face_of_[u] = f;
    }
    face_of_[v] = kNone;
    free_vertices_.push_back(v);
    --live_vertices_;
}

}  // namespace imgmesh
