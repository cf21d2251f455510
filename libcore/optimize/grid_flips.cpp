// Flips of edges.
#include "libcore/base/index.h"
#include "libcore/optimize/grid_state.h"

namespace imgmesh {

bool GridState::cost_flip(Flip& flip) const {
    const Spot &sp = spot_[flip.p], &sa = spot_[flip.a], &sb = spot_[flip.b], &sq = spot_[flip.q];
    double first_shape = 0, second_shape = 0;
    if (!rules_.admits(sp.place, sa.place, sq.place, first_shape) ||
        !rules_.admits(sq.place, sb.place, sp.place, second_shape))
        return false;
    const FlipFit fit = fit_flip(*sums_, sp, sa, sq, sb);
    flip.first = fit.first + first_shape;
    flip.second = fit.second + second_shape;
    flip.cost = flip.first + flip.second - cost_[flip.f] - cost_[flip.g];
    return true;
}

bool GridState::do_flip(const Flip& flip, Worker& worker) {
    if (!mesh_.may_flip(flip.f, flip.i)) return false;
    changed(flip.f, worker.tick);
    changed(flip.g, worker.tick);
    mesh_.flip(flip.f, flip.i);
    cost_[flip.f] = flip.first;
    cost_[flip.g] = flip.second;
    return true;
}

template <class Visit>
bool GridState::for_each_flip(Id v, const Worker& worker, Visit&& visit) {
    OneRing ring;
    if (!mesh_.live_vertex(v) || !mesh_.ring(v, ring)) return true;
    bool complete = true;
    std::size_t k = ring.closed ? 0 : 1;
    for (std::size_t left = ring.faces - k; left > 0; --left) {
        const std::size_t before = k > 0 ? k - 1 : ring.faces - 1;
        Flip flip{.f = ring.face[k],
                  .g = ring.face[before],
                  .i = (ring.corner[k] + std::size_t{2}) % 3,
                  .p = ring.vertex[k + 1],
                  .a = v,
                  .b = ring.vertex[k],
                  .q = ring.vertex[before]};
        k = ring.closed && k + 1 == ring.faces ? 0 : k + 1;
        if (flip.b < v) continue;
        if (!worker.claims(flip.b) || !worker.claims(flip.p) || !worker.claims(flip.q)) {
            complete = false;
        } else if (visit(flip)) {
            mesh_.ring(v, ring);
            k = as_index(ring.find(flip.p));
        }
    }
    return complete;
}

void GridState::flip_edges(Id v, Worker& worker) {
    // Two faces that have not changed since then give the same answer.
    const std::uint64_t checked = vertex_[v].checked, now = worker.tick;
    bool refused = false;
    const bool complete = for_each_flip(v, worker, [&](Flip& flip) {
        if (changed_[flip.f] <= checked && changed_[flip.g] <= checked) return false;
        if (!cost_flip(flip) || !(flip.cost < -1e-9 * (flip.first + flip.second))) return false;
        if (do_flip(flip, worker)) return true;
        refused = true;
        return false;
    });
    vertex_[v].checked = refused || !complete ? 0 : now;
}

void GridState::anneal_flips(Id v, double temperature, Worker& worker) {
    for_each_flip(v, worker, [&](Flip& flip) {
        return cost_flip(flip) && flip.cost < temperature * worker.random.exponential() &&
               do_flip(flip, worker);
    });
}

}  // namespace imgmesh
