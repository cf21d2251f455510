// Relocation: vertices move from where their loss costs least to where another one gains most.
#include <algorithm>
#include <cmath>
#include <limits>

#include "libcore/base/dot.h"
#include "libcore/base/for_each_id.h"
#include "libcore/refine/refiner.h"

namespace imgmesh {
// Half-edge collapse of v into the neighbour where the error grows least.
Refiner::Removal Refiner::best_removal(Id v) const {
    Removal best{v, kNone, std::numeric_limits<double>::infinity(), false};
    OneRing ring;
    if (!mesh_.live_vertex(v) || vertex_.fixed[v] == RefineVertices::kFixed || !mesh_.ring(v, ring))
        return best;
    const Cost before = cost_of(ring);
    // Neighbours of the most similar colour come first: the sum stops when it exceeds the best so far.
    std::array<std::pair<float, Id>, OneRing::kMaxFaces> neighbors;
    std::size_t count = 0;
    const auto add = [&](Id u) {
        neighbors[count++] = {(vertex_.color[u] - vertex_.color[v]).squaredNorm(), u};
    };
    if (ring.closed) {
        for (std::size_t k = 0; k < ring.faces; ++k) add(ring.vertex[k]);
    } else {
        // A vertex on a side moves only along that side.
        for (const Id u : {ring.vertex[0], ring.vertex[ring.faces]})
            if ((vertex_.fixed[u] & vertex_.fixed[v]) == vertex_.fixed[v]) add(u);
    }
    std::sort(neighbors.begin(), neighbors.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t n = 0; n < count; ++n) {
        const Id u = neighbors[n].second;
        Cost after;
        for (std::size_t k = 0; k < ring.faces && after.legal; ++k)
            if (!ring.has(k, u))
                add_shape(after, vertex_.position[u], vertex_.position[ring.vertex[k]],
                          vertex_.position[ring.vertex[k + 1]]);
        if (!after.legal || after.least_q < std::min(before.least_q, params_.min_quality)) continue;
        const double shape = shape_unit_ * (after.shape - before.shape);
        for (std::size_t k = 0; k < ring.faces && after.error - before.error + shape < best.cost; ++k)
            if (!ring.has(k, u)) after.error += face_error({u, ring.vertex[k], ring.vertex[k + 1]});
        const double cost = after.error - before.error + shape;
        if (cost < best.cost) best = {v, u, cost, !ring.closed};
    }
    return best;
}

void Refiner::try_insertion(Id f, int edge, const Vec2f& position, Insertion& best) const {
    const auto [a, b, c] = mesh_.face(f);
    Cost before, after;
    std::array<Face, 4> faces;  // the new vertex is corner 0 of each
    std::size_t count = 0;
    const auto add_before = [&](Id face) {
        before.error += error_[face];
        const auto [i, j, k] = mesh_.face(face);
        add_shape(before, vertex_.position[i], vertex_.position[j], vertex_.position[k]);
    };
    add_before(f);
    if (edge < 0) {
        faces = {Face{kNone, a, b}, {kNone, b, c}, {kNone, c, a}};
        count = 3;
    } else {
        const auto n = static_cast<std::size_t>(edge);
        const Face& face = mesh_.face(f);
        const Id o = face[n], p = face[(n + 1) % 3], q = face[(n + 2) % 3];
        faces = {Face{kNone, o, p}, {kNone, q, o}};
        count = 2;
        if (const Id g = mesh_.across(f, n); g != kNone) {
            add_before(g);
            const Id r = mesh_.apex(g, f);
            faces[2] = {kNone, p, r};
            faces[3] = {kNone, r, q};
            count = 4;
        }
    }
    for (std::size_t k = 0; k < count; ++k)
        add_shape(after, position, vertex_.position[faces[k][1]], vertex_.position[faces[k][2]]);
    if (!after.legal || after.least_q < std::min(before.least_q, params_.min_quality)) return;
    // First with the drawing's colour there, then with the best one.
    const Vec2f &pa = vertex_.position[a], &pb = vertex_.position[b], &pc = vertex_.position[c];
    const double area2 = signed_area2(pa, pb, pc);
    const auto wb = static_cast<float>(signed_area2(pa, position, pc) / area2),
               wc = static_cast<float>(signed_area2(pa, pb, position) / area2);
    const Vec3f color = (1 - wb - wc) * vertex_.color[a] + wb * vertex_.color[b] + wc * vertex_.color[c];
    double ww = 1e-3;
    Vec3d we = Vec3d::Zero();
    for (std::size_t k = 0; k < count; ++k) {
        const CornerSums sums =
            corner_sums(image_, {position, color}, corner(faces[k][1]), corner(faces[k][2]));
        after.error += sums.ee;
        ww += sums.ww;
        we += sums.we;
    }
    const Vec3f chosen = allowed(color - (we / ww).cast<float>());
    const Vec3d change = (chosen - color).cast<double>();
    after.error += 2 * dot(change, we) + (ww - 1e-3) * dot(change, change);
    const double gain = before.error - after.error + shape_unit_ * (before.shape - after.shape);
    if (gain > best.gain) best = {f, edge, position, chosen, gain, edge >= 0 && count == 2};
}

Refiner::Insertion Refiner::best_insertion(Id f) const {
    Insertion best{f, -1, {}, {}, 0, false};
    if (!mesh_.live_face(f)) return best;
    const auto [a, b, c] = mesh_.face(f);
    const Vec2f center = (vertex_.position[a] + vertex_.position[b] + vertex_.position[c]) / 3;
    try_insertion(f, -1, {snapped(center.x()), snapped(center.y())}, best);
    const WorstPixel worst = worst_pixel(image_, corner(a), corner(b), corner(c));
    if (worst.x >= 0) try_insertion(f, -1, {static_cast<float>(worst.x), static_cast<float>(worst.y)}, best);
    for (std::size_t n = 0; n < 3; ++n) {
        const Id g = mesh_.across(f, n), p = mesh_.face(f)[(n + 1) % 3], q = mesh_.face(f)[(n + 2) % 3];
        // Inner edges are tried once; a border edge only if it is on a side.
        if (g != kNone && g < f) continue;
        const std::uint8_t side = vertex_.fixed[p] & vertex_.fixed[q];
        if (g == kNone && side != kFixedX && side != kFixedY) continue;
        const Vec2f middle = (vertex_.position[p] + vertex_.position[q]) / 2;
        const Vec2f at(g == kNone && side == kFixedX ? vertex_.position[p].x() : snapped(middle.x()),
                       g == kNone && side == kFixedY ? vertex_.position[p].y() : snapped(middle.y()));
        try_insertion(f, static_cast<int>(n), at, best);
    }
    return best;
}

void Refiner::changed(const OneRing& ring) {
    for (std::size_t k = 0; k < ring.faces; ++k) changed(ring.face[k]);
}
void Refiner::changed(Id f) {
    for (const Id v : mesh_.face(f))
        if (v < removal_holds_.size()) removal_holds_[v] = false;
}
void Refiner::forget() {
    removal_holds_.assign(mesh_.vertices(), false);
}

void Refiner::remove(const Removal& removal) {
    OneRing ring;
    mesh_.ring(removal.v, ring);
    changed(ring);
    mesh_.collapse(ring, removal.into);
    // A removed face had one neighbour at v. The ring of their common vertex now begins with that neighbour.
    for (std::size_t k = 0; k < ring.faces; ++k) {
        const Id f = ring.face[k];
        error_[f] = mesh_.live_face(f) ? face_error(mesh_.face(f)) : 0;
        if (mesh_.live_face(f))
            mesh_.begin_ring(removal.into, f);
        else if (ring.vertex[k] == removal.into)
            mesh_.begin_ring(ring.vertex[k + 1], ring.face[(k + 1) % ring.faces]);
        else
            mesh_.begin_ring(ring.vertex[k], ring.face[(k + ring.faces - 1) % ring.faces]);
    }
}

Id Refiner::insert(const Insertion& insertion) {
    // A vertex on the border keeps the coordinates that both ends of the edge keep.
    std::uint8_t fixed = RefineVertices::kFree;
    Id v;
    if (insertion.edge < 0) {
        v = mesh_.split_face(insertion.face);
    } else {
        const auto i = static_cast<std::size_t>(insertion.edge);
        const Face face = mesh_.face(insertion.face);
        if (insertion.border) fixed = vertex_.fixed[face[(i + 1) % 3]] & vertex_.fixed[face[(i + 2) % 3]];
        v = mesh_.split_edge(insertion.face, i);
    }
    vertex_.set(v, insertion.position, insertion.color, fixed);
    error_.resize(mesh_.faces().size(), 0.0);
    OneRing ring;
    mesh_.ring(v, ring);
    changed(ring);
    for (std::size_t k = 0; k < ring.faces; ++k) error_[ring.face[k]] = face_error(mesh_.face(ring.face[k]));
    return v;
}

Id Refiner::across(const Insertion& insertion) const {
    return insertion.edge < 0 ? kNone
                              : mesh_.across(insertion.face, static_cast<std::size_t>(insertion.edge));
}

std::vector<Refiner::Removal> Refiner::removals() {
    const std::size_t vertices = mesh_.vertices();
    removal_.resize(vertices, {});
    removal_holds_.resize(vertices, false);
    for_each_id(vertices, [&](Id v) {
        if (!removal_holds_[v]) removal_[v] = best_removal(v);
        removal_holds_[v] = true;
    });
    std::vector<Removal> all;
    std::copy_if(removal_.begin(), removal_.end(), std::back_inserter(all),
                 [](const Removal& removal) { return removal.into != kNone; });
    std::sort(all.begin(), all.end(), [](const Removal& a, const Removal& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.v < b.v;
    });
    return all;
}

std::vector<Refiner::Insertion> Refiner::insertions() const {
    std::vector<Insertion> all(mesh_.faces().size());
    for_each_id(all.size(), [&](Id f) { all[f] = best_insertion(f); });
    std::erase_if(all, [](const Insertion& insertion) { return !(insertion.gain > 0); });
    std::sort(all.begin(), all.end(), [](const Insertion& a, const Insertion& b) {
        return a.gain != b.gain ? a.gain > b.gain : a.face < b.face;
    });
    return all;
}

// Remembered results for a face or a vertex hold only until something near it changes.
std::int64_t Refiner::insert_best(std::int64_t most) {
    TouchedFaces touched(mesh_.faces().size());
    std::int64_t done = 0;
    OneRing ring;
    for (const Insertion& insertion : insertions()) {
        if (done == most) break;
        const Id g = across(insertion);
        if (insertion.border || touched.has(insertion.face) || touched.has(g)) continue;
        const Id v = insert(insertion);
        move_vertex(v);
        mesh_.ring(v, ring);
        touched.add(ring);
        ++done;
    }
    return done;
}

std::int64_t Refiner::remove_cheapest(std::int64_t most) {
    TouchedFaces touched(mesh_.faces().size());
    std::int64_t done = 0;
    OneRing ring;
    for (const Removal& removal : removals()) {
        if (done == most) break;
        if (removal.border) continue;
        mesh_.ring(removal.v, ring);
        if (touched.has_any(ring) || !mesh_.may_collapse(ring, removal.into)) continue;
        touched.add(ring);
        remove(removal);
        ++done;
    }
    return done;
}

bool Refiner::exchange(double share) {
    const EditMesh mesh = mesh_;
    const RefineVertices vertices = vertex_;
    const std::vector<double> error = error_;
    const double before = total_error();
    const auto settle = [&] {
        flip_edges();
        move_vertices();
        fit_colors();
    };
    const std::int64_t extra =
        insert_best(static_cast<std::int64_t>(std::ceil(share * static_cast<double>(mesh_.live_vertices()))));
    settle();
    settle();
    std::int64_t left = extra;
    // In parts, because each removal changes the costs of the next ones.
    while (left > 0) {
        const std::int64_t done = remove_cheapest(std::max<std::int64_t>(1, (left + 1) / 2));
        if (done == 0) break;
        left -= done;
        flip_edges();
    }
    settle();
    if (left == 0 && total_error() < before) return true;
    mesh_ = mesh;
    vertex_ = vertices;
    error_ = error;
    forget();
    return false;
}

std::int64_t Refiner::relocate() {
    const auto most =
        static_cast<std::size_t>(std::ceil(params_.relocations * static_cast<double>(mesh_.live_vertices())));
    const std::vector<Removal> removals = this->removals();
    const std::vector<Insertion> insertions = this->insertions();
    // Remembered results for a face or a vertex hold only until something near it changes.
    TouchedFaces touched(mesh_.faces().size());
    std::vector<Id> fresh;
    // Inner vertices are exchanged for inner ones, so the number of faces stays.
    for (const bool border : {false, true}) relocate(most, removals, insertions, border, touched, fresh);
    for (const Id v : fresh) move_vertex(v);
    return static_cast<std::int64_t>(fresh.size());
}

void Refiner::relocate(std::size_t most, const std::vector<Removal>& removals,
                       const std::vector<Insertion>& insertions, bool border, TouchedFaces& touched,
                       std::vector<Id>& fresh) {
    OneRing ring;
    std::size_t next_removal = 0;
    for (const Insertion& insertion : insertions) {
        if (fresh.size() >= most) return;
        const Id g = across(insertion);
        if (insertion.border != border || touched.has(insertion.face) || touched.has(g)) continue;
        // The cheapest removal whose ring neither was touched nor holds the insertion.
        bool found = false;
        while (next_removal < removals.size() && !found) {
            const Removal& removal = removals[next_removal++];
            if (!(insertion.gain > removal.cost)) return;
            if (removal.border != border) continue;
            mesh_.ring(removal.v, ring);
            found = !touched.has_any(ring) && mesh_.may_collapse(ring, removal.into);
            for (std::size_t k = 0; k < ring.faces; ++k)
                found = found && ring.face[k] != insertion.face && ring.face[k] != g;
            if (!found) continue;
            touched.add(ring);
            remove(removal);
            fresh.push_back(insert(insertion));
            mesh_.ring(fresh.back(), ring);
            touched.add(ring);
        }
    }
}

}  // namespace imgmesh
