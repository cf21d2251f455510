// Relocation: vertices go from where their loss costs least to where one more gains most.
#include <algorithm>
#include <cmath>
#include <limits>

#include "libcore/refine/for_each_id.h"
#include "libcore/refine/refiner.h"

namespace imgmesh {
// Half-edge collapse of v into the neighbour where the error grows least.
Refiner::Removal Refiner::best_removal(Id v) const {
    Removal best{v, kNone, std::numeric_limits<double>::infinity(), false};
    Star star;
    if (!mesh_.live_vertex(v) || mesh_.fixed[v] == RefineMesh::kFixed || !mesh_.star(v, star)) return best;
    const Cost before = cost_of(star);
    const auto size = static_cast<std::size_t>(star.size);
    const auto other = [&](std::size_t k, unsigned step) {
        return mesh_.faces[star.face[k]][(star.corner[k] + step) % 3];
    };
    // Those of the most similar colour first: what costs more than the best so far need not be summed up.
    std::array<std::pair<float, Id>, Star::kMost> neighbors;
    std::size_t count = 0;
    const auto add = [&](Id u) { neighbors[count++] = {(mesh_.color[u] - mesh_.color[v]).squaredNorm(), u}; };
    if (star.closed) {
        for (std::size_t n = 0; n < size; ++n) add(other(n, 1));
    } else {
        // A vertex of a side goes along its side only.
        for (const Id u : {other(0, 1), other(size - 1, 2)})
            if ((mesh_.fixed[u] & mesh_.fixed[v]) == mesh_.fixed[v]) add(u);
    }
    std::sort(neighbors.begin(), neighbors.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t n = 0; n < count; ++n) {
        const Id u = neighbors[n].second;
        Cost after;
        for (std::size_t k = 0; k < size && after.legal; ++k)
            if (other(k, 1) != u && other(k, 2) != u)
                add_shape(after, mesh_.position[u], mesh_.position[other(k, 1)], mesh_.position[other(k, 2)]);
        if (!after.legal || after.least_q < std::min(before.least_q, params_.min_quality)) continue;
        const double shape = shape_unit_ * (after.shape - before.shape);
        for (std::size_t k = 0; k < size && after.error - before.error + shape < best.cost; ++k)
            if (other(k, 1) != u && other(k, 2) != u)
                after.error += face_error({u, other(k, 1), other(k, 2)});
        const double cost = after.error - before.error + shape;
        if (cost < best.cost) best = {v, u, cost, !star.closed};
    }
    return best;
}

void Refiner::try_insertion(Id f, int edge, const Vec2f& position, Insertion& best) const {
    const auto [a, b, c] = mesh_.faces[f];
    Cost before, after;
    std::array<Face, 4> faces;  // the new vertex is corner 0 of each
    std::size_t count = 0;
    const auto add_before = [&](Id face) {
        before.error += error_[face];
        const auto [i, j, k] = mesh_.faces[face];
        add_shape(before, mesh_.position[i], mesh_.position[j], mesh_.position[k]);
    };
    add_before(f);
    if (edge < 0) {
        faces = {Face{kNone, a, b}, {kNone, b, c}, {kNone, c, a}};
        count = 3;
    } else {
        const auto n = static_cast<std::size_t>(edge);
        const Face& face = mesh_.faces[f];
        const Id o = face[n], p = face[(n + 1) % 3], q = face[(n + 2) % 3];
        faces = {Face{kNone, o, p}, {kNone, q, o}};
        count = 2;
        if (const Id g = mesh_.across[f][n]; g != kNone) {
            add_before(g);
            const std::size_t j = mesh_.across[g][0] == f ? 0 : mesh_.across[g][1] == f ? 1 : 2;
            const Id r = mesh_.faces[g][j];
            faces[2] = {kNone, p, r};
            faces[3] = {kNone, r, q};
            count = 4;
        }
    }
    for (std::size_t k = 0; k < count; ++k)
        add_shape(after, position, mesh_.position[faces[k][1]], mesh_.position[faces[k][2]]);
    if (!after.legal || after.least_q < std::min(before.least_q, params_.min_quality)) return;
    // The colour that the drawing has there, then the best one.
    const Vec2f &pa = mesh_.position[a], &pb = mesh_.position[b], &pc = mesh_.position[c];
    const double area2 = signed_area2(pa, pb, pc);
    const auto wb = static_cast<float>(signed_area2(pa, position, pc) / area2),
               wc = static_cast<float>(signed_area2(pa, pb, position) / area2);
    const Vec3f color = (1 - wb - wc) * mesh_.color[a] + wb * mesh_.color[b] + wc * mesh_.color[c];
    double ww = 1e-3;
    Vec3d we = Vec3d::Zero();
    for (std::size_t k = 0; k < count; ++k) {
        const CornerSums sums =
            corner_sums(picture_, {position, color}, corner(faces[k][1]), corner(faces[k][2]));
        after.error += sums.ee;
        ww += sums.ww;
        we += sums.we;
    }
    const Vec3f chosen = allowed(color - (we / ww).cast<float>());
    const Vec3d change = (chosen - color).cast<double>();
    after.error += 2 * change.dot(we) + (ww - 1e-3) * change.squaredNorm();
    const double gain = before.error - after.error + shape_unit_ * (before.shape - after.shape);
    if (gain > best.gain) best = {f, edge, position, chosen, gain, edge >= 0 && count == 2};
}

Refiner::Insertion Refiner::best_insertion(Id f) const {
    Insertion best{f, -1, {}, {}, 0, false};
    if (!mesh_.live_face(f)) return best;
    const auto [a, b, c] = mesh_.faces[f];
    const Vec2f center = (mesh_.position[a] + mesh_.position[b] + mesh_.position[c]) / 3;
    try_insertion(f, -1, {snapped(center.x()), snapped(center.y())}, best);
    const WorstPixel worst = worst_pixel(picture_, corner(a), corner(b), corner(c));
    if (worst.x >= 0) try_insertion(f, -1, {static_cast<float>(worst.x), static_cast<float>(worst.y)}, best);
    for (int i = 0; i < 3; ++i) {
        const auto n = static_cast<std::size_t>(i);
        const Id g = mesh_.across[f][n], p = mesh_.faces[f][(n + 1) % 3], q = mesh_.faces[f][(n + 2) % 3];
        // Inner edges are tried once; a border edge only where it is a side's.
        if (g != kNone && g < f) continue;
        const std::uint8_t side = mesh_.fixed[p] & mesh_.fixed[q];
        if (g == kNone && side != RefineMesh::kFixedX && side != RefineMesh::kFixedY) continue;
        const Vec2f middle = (mesh_.position[p] + mesh_.position[q]) / 2;
        const Vec2f at(
            g == kNone && side == RefineMesh::kFixedX ? mesh_.position[p].x() : snapped(middle.x()),
            g == kNone && side == RefineMesh::kFixedY ? mesh_.position[p].y() : snapped(middle.y()));
        try_insertion(f, i, at, best);
    }
    return best;
}

void Refiner::changed(const Star& star) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(star.size); ++k) changed(star.face[k]);
}
void Refiner::changed(Id f) {
    for (const Id v : mesh_.faces[f])
        if (v < removal_holds_.size()) removal_holds_[v] = false;
}
void Refiner::forget() {
    removal_holds_.assign(mesh_.position.size(), false);
}

void Refiner::remove(const Removal& removal) {
    Star star;
    mesh_.star(removal.v, star);
    changed(star);
    mesh_.collapse(star, removal.v, removal.into);
    for (std::size_t k = 0; k < static_cast<std::size_t>(star.size); ++k)
        error_[star.face[k]] = mesh_.live_face(star.face[k]) ? face_error(mesh_.faces[star.face[k]]) : 0;
}

Id Refiner::insert(const Insertion& insertion) {
    const Id v = insertion.edge < 0
                     ? mesh_.split_face(insertion.face, insertion.position, insertion.color)
                     : mesh_.split_edge(insertion.face, insertion.edge, insertion.position, insertion.color);
    error_.resize(mesh_.faces.size(), 0.0);
    Star star;
    mesh_.star(v, star);
    changed(star);
    for (std::size_t k = 0; k < static_cast<std::size_t>(star.size); ++k)
        error_[star.face[k]] = face_error(mesh_.faces[star.face[k]]);
    return v;
}

Id Refiner::across(const Insertion& insertion) const {
    return insertion.edge < 0 ? kNone
                              : mesh_.across[insertion.face][static_cast<std::size_t>(insertion.edge)];
}

std::vector<Refiner::Removal> Refiner::removals() {
    const std::size_t vertices = mesh_.position.size();
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
    std::vector<Insertion> all(mesh_.faces.size());
    for_each_id(all.size(), [&](Id f) { all[f] = best_insertion(f); });
    std::erase_if(all, [](const Insertion& insertion) { return !(insertion.gain > 0); });
    std::sort(all.begin(), all.end(), [](const Insertion& a, const Insertion& b) {
        return a.gain != b.gain ? a.gain > b.gain : a.face < b.face;
    });
    return all;
}

// What is known of a face or a vertex holds only until something near it changes.
std::int64_t Refiner::insert_best(std::int64_t most) {
    std::vector<bool> touched(mesh_.faces.size(), false);
    std::int64_t done = 0;
    for (const Insertion& insertion : insertions()) {
        if (done == most) break;
        const Id g = across(insertion);
        if (insertion.border || touched[insertion.face] || (g != kNone && touched[g])) continue;
        touched[insertion.face] = true;
        if (g != kNone) touched[g] = true;
        move_vertex(insert(insertion));
        touched.resize(mesh_.faces.size(), true);
        ++done;
    }
    return done;
}

std::int64_t Refiner::remove_cheapest(std::int64_t most) {
    std::vector<bool> touched(mesh_.faces.size(), false);
    std::int64_t done = 0;
    Star star;
    for (const Removal& removal : removals()) {
        if (done == most) break;
        if (removal.border) continue;
        mesh_.star(removal.v, star);
        bool free = true;
        for (std::size_t k = 0; k < static_cast<std::size_t>(star.size); ++k)
            free = free && !touched[star.face[k]];
        if (!free) continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(star.size); ++k) touched[star.face[k]] = true;
        remove(removal);
        ++done;
    }
    return done;
}

bool Refiner::exchange(double share) {
    const RefineMesh mesh = mesh_;
    const std::vector<double> error = error_;
    const double before = total_error();
    const auto settle = [&] {
        flip_edges();
        move_vertices();
        fit_colors();
    };
    const std::int64_t extra =
        insert_best(static_cast<std::int64_t>(std::ceil(share * static_cast<double>(mesh_.vertex_count()))));
    settle();
    settle();
    std::int64_t left = extra;
    // In parts, as each removal changes what the next ones cost.
    while (left > 0) {
        const std::int64_t done = remove_cheapest(std::max<std::int64_t>(1, (left + 1) / 2));
        if (done == 0) break;
        left -= done;
        flip_edges();
    }
    settle();
    if (left == 0 && total_error() < before) return true;
    mesh_ = mesh;
    error_ = error;
    forget();
    return false;
}

std::int64_t Refiner::relocate() {
    const auto most =
        static_cast<std::size_t>(std::ceil(params_.relocations * static_cast<double>(mesh_.vertex_count())));
    const std::vector<Removal> removals = this->removals();
    const std::vector<Insertion> insertions = this->insertions();
    // What is known of a face or a vertex holds only until something near it changes.
    std::vector<bool> touched(mesh_.faces.size(), false);
    std::vector<Id> fresh;
    // Inner vertices are exchanged for inner ones: the number of faces stays.
    for (const bool border : {false, true}) relocate(most, removals, insertions, border, touched, fresh);
    for (const Id v : fresh) move_vertex(v);
    return static_cast<std::int64_t>(fresh.size());
}

void Refiner::relocate(std::size_t most, const std::vector<Removal>& removals,
                       const std::vector<Insertion>& insertions, bool border, std::vector<bool>& touched,
                       std::vector<Id>& fresh) {
    Star star;
    std::size_t next_removal = 0;
    for (const Insertion& insertion : insertions) {
        if (fresh.size() >= most) return;
        const Id g = across(insertion);
        if (insertion.border != border || touched[insertion.face] || (g != kNone && touched[g])) continue;
        // The cheapest removal whose star neither was touched nor holds the insertion.
        bool found = false;
        while (next_removal < removals.size() && !found) {
            const Removal& removal = removals[next_removal++];
            if (!(insertion.gain > removal.cost)) return;
            if (removal.border != border) continue;
            mesh_.star(removal.v, star);
            found = true;
            for (std::size_t k = 0; k < static_cast<std::size_t>(star.size); ++k)
                found =
                    found && !touched[star.face[k]] && star.face[k] != insertion.face && star.face[k] != g;
            if (!found) continue;
            for (std::size_t k = 0; k < static_cast<std::size_t>(star.size); ++k)
                touched[star.face[k]] = true;
            touched[insertion.face] = true;
            if (g != kNone) touched[g] = true;
            remove(removal);
            fresh.push_back(insert(insertion));
            touched.resize(mesh_.faces.size(), true);
        }
    }
}

}  // namespace imgmesh
