// Vertices that come where they gain most, and go where they cost least.
#include <algorithm>
#include <limits>

#include "libcore/base/for_each_id.h"
#include "libcore/mesh/fixed_axes.h"
#include "libcore/mesh/touched_faces.h"
#include "libcore/optimize/grid_state.h"

namespace imgmesh {

// Half-edge collapse of v into the neighbour where the error grows least.
GridState::Removal GridState::best_removal(Id v) const {
    Removal best{v, kNone, std::numeric_limits<double>::infinity()};
    OneRing ring;
    Fan fan;
    if (!may_move(v, ring, {})) return best;
    fan_of(ring, fan);
    const double before = cost_of(ring);
    for (std::size_t n = 0; n < ring.vertices(); ++n) {
        // A vertex on a side goes only along that side.
        if (!ring.closed && n != 0 && n != ring.faces) continue;
        const Id u = ring.vertex[n];
        bool legal = true;
        double after = 0, shape = 0;
        for (std::size_t k = 0; k < ring.faces && legal; ++k) {
            if (ring.has(k, u)) continue;
            legal = rules_.admits(spot_[u].place, fan.spot[k].place, fan.spot[k + 1].place, shape);
            after += shape;
        }
        if (!legal) continue;
        // The faces form a fan around u: a part of the ring, from one neighbour of u to the other.
        Moments spoke = {}, next;
        bool known = false;
        const std::size_t start = ring.closed ? n + 1 : 0;
        for (std::size_t j = 0; j < ring.faces && after - before < best.cost; ++j) {
            const std::size_t k = (start + j) % ring.faces;
            if (ring.has(k, u)) {
                known = false;
                continue;
            }
            if (!known) sums_->edge(spot_[u].place, fan.spot[k].place, spoke);
            sums_->edge(spot_[u].place, fan.spot[k + 1].place, next);
            Moments face = fan.link[k];
            add(face, spoke);
            subtract(face, next);
            after += corner_fit(face, spot_[u].place, fan.spot[k], fan.spot[k + 1]).error(spot_[u].color);
            spoke = next;
            known = true;
        }
        if (after - before < best.cost) best = {v, u, after - before};
    }
    return best;
}

void GridState::remove(const Removal& removal) {
    OneRing ring;
    mesh_.ring(removal.v, ring);
    for (std::size_t k = 0; k < ring.faces; ++k) changed(ring.face[k]);
    mesh_.collapse(ring, removal.into);
    for (std::size_t k = 0; k < ring.faces; ++k) {
        const Id f = ring.face[k];
        cost_[f] = mesh_.live_face(f) ? face_cost(mesh_.face(f)) : 0;
    }
}

std::size_t GridState::remove_cheapest(std::size_t most, std::size_t border, std::size_t inner) {
    removal_.resize(vertex_.size());
    for_each_id(vertex_.size(), [&](Id v) {
        if (!vertex_[v].removal_holds) removal_[v] = best_removal(v);
        vertex_[v].removal_holds = true;
    });
    std::vector<Removal> all;
    for (const Removal& removal : removal_)
        if (removal.into != kNone) all.push_back(removal);
    std::sort(all.begin(), all.end(), [](const Removal& a, const Removal& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.v < b.v;
    });
    TouchedFaces touched(cost_.size());
    std::size_t done = 0;
    OneRing ring;
    for (const Removal& removal : all) {
        if (done == most) break;
        mesh_.ring(removal.v, ring);
        std::size_t& left = vertex_[removal.v].fixed != 0 ? border : inner;
        if (left == 0 || touched.has_any(ring) || !mesh_.may_collapse(ring, removal.into)) continue;
        --left;
        touched.add(ring);
        remove(removal);
        ++done;
    }
    return done;
}

void GridState::try_insertion(Id f, int edge, std::int32_t column, std::int32_t row, Insertion& best) const {
    Fan fan;
    double before = cost_[f];
    const Face& face = mesh_.face(f);
    if (edge < 0) {
        fan.faces = 3;
        fan.closed = true;
        for (std::size_t k = 0; k < 4; ++k) fan.spot[k] = spot_[face[k % 3]];
    } else {
        const auto i = static_cast<std::size_t>(edge);
        const Spot &o = spot_[face[i]], &p = spot_[face[(i + 1) % 3]], &q = spot_[face[(i + 2) % 3]];
        const Id g = mesh_.across(f, i);
        fan.faces = 2;
        fan.spot[0] = q;
        fan.spot[1] = o;
        fan.spot[2] = p;
        if (g != kNone) {
            before += cost_[g];
            fan.faces = 4;
            fan.closed = true;
            fan.spot[3] = spot_[mesh_.apex(g, f)];
            fan.spot[4] = q;
        }
    }
    const Place at = place(column, row);
    FanFit fit;
    if (!rules_.admits(fan, at, fit)) return;
    fan.measure_links(*sums_);
    fit_admitted(fan, at, (fan.spot[0].color + fan.spot[1].color + fan.spot[2].color) / 3, fit);
    const double gain = before - fit.error;
    if (gain > best.gain) best = {f, edge, column, row, fit.color, gain};
}

GridState::Insertion GridState::best_insertion(Id f) const {
    Insertion best{f, -1, 0, 0, {}, 0};
    if (!mesh_.live_face(f)) return best;
    const Face& face = mesh_.face(f);
    // Nearest grid point of a mean of the corners with these weights, in fifths.
    constexpr std::int32_t kInside[6][3] = {{3, 1, 1}, {1, 3, 1}, {1, 1, 3}, {1, 2, 2}, {2, 1, 2}, {2, 2, 1}};
    const auto line = [](std::int32_t sum, std::int32_t parts) { return (2 * sum + parts) / (2 * parts); };
    const Vertex &a = vertex_[face[0]], &b = vertex_[face[1]], &c = vertex_[face[2]];
    for (const auto& w : kInside)
        try_insertion(f, -1, line(w[0] * a.column + w[1] * b.column + w[2] * c.column, 5),
                      line(w[0] * a.row + w[1] * b.row + w[2] * c.row, 5), best);
    for (std::size_t i = 0; i < 3; ++i) {
        const Id g = mesh_.across(f, i);
        if (g != kNone && g < f) continue;
        // Boundaries take new vertices only on the sides of the image.
        if (g == kNone && side_of(face[(i + 1) % 3], face[(i + 2) % 3]) == (kFixedX | kFixedY)) continue;
        const Vertex &p = vertex_[face[(i + 1) % 3]], &q = vertex_[face[(i + 2) % 3]];
        try_insertion(f, static_cast<int>(i), line(p.column + q.column, 2), line(p.row + q.row, 2), best);
    }
    return best;
}

Id GridState::insert(const Insertion& insertion) {
    std::uint8_t fixed = 0;
    Id v;
    if (insertion.edge < 0) {
        v = mesh_.split_face(insertion.face);
    } else {
        const std::size_t i = as_index(insertion.edge);
        const Face& face = mesh_.face(insertion.face);
        if (mesh_.across(insertion.face, i) == kNone) fixed = side_of(face[(i + 1) % 3], face[(i + 2) % 3]);
        v = mesh_.split_edge(insertion.face, i);
    }
    if (v >= vertex_.size()) {
        vertex_.resize(v + 1);
        spot_.resize(v + 1);
    }
    vertex_[v] = {.column = insertion.column, .row = insertion.row, .step = first_step_, .fixed = fixed};
    spot_[v] = {place(insertion.column, insertion.row), insertion.color};
    cost_.resize(mesh_.faces().size(), 0.0);
    changed_.resize(cost_.size());
    OneRing ring;
    mesh_.ring(v, ring);
    for (std::size_t k = 0; k < ring.faces; ++k) {
        changed(ring.face[k]);
        cost_[ring.face[k]] = face_cost(mesh_.face(ring.face[k]));
    }
    Worker worker{.tick = tick_};
    move_vertex(v, worker);
    tick_ = worker.tick;
    return v;
}

std::size_t GridState::insert_best(std::size_t most) {
    std::vector<Insertion> all(cost_.size());
    for_each_id(all.size(), [&](Id f) { all[f] = best_insertion(f); });
    std::erase_if(all, [](const Insertion& insertion) { return !(insertion.gain > 0); });
    std::sort(all.begin(), all.end(), [](const Insertion& a, const Insertion& b) {
        return a.gain != b.gain ? a.gain > b.gain : a.face < b.face;
    });
    TouchedFaces touched(cost_.size());
    std::size_t done = 0;
    OneRing ring;
    for (const Insertion& insertion : all) {
        if (done == most) break;
        const Id f = insertion.face,
                 g = insertion.edge < 0 ? kNone : mesh_.across(f, as_index(insertion.edge));
        if (touched.has(f) || touched.has(g)) continue;
        const Id v = insert(insertion);
        // New faces may have the ids of removed ones.
        mesh_.ring(v, ring);
        touched.add(ring);
        ++done;
    }
    return done;
}

}  // namespace imgmesh
