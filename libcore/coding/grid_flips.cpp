// Flips of edges.
#include "libcore/coding/grid_state.h"

namespace imgmesh {

bool GridState::cost_flip(Flip& flip) const {
    const Face& face = mesh_.face(flip.f);
    const Id p = face[flip.i], a = face[(flip.i + 1) % 3], b = face[(flip.i + 2) % 3];
    const Id q = mesh_.apex(flip.g, flip.f);
    const Spot &sp = spot_[p], &sa = spot_[a], &sb = spot_[b], &sq = spot_[q];
    if (!is_legal(sp.place, sa.place, sq.place, weights_.min_fatness) ||
        !is_legal(sq.place, sb.place, sp.place, weights_.min_fatness))
        return false;
    Moments first, second, edge;
    sums_->edge(sp.place, sa.place, first);
    sums_->edge(sa.place, sq.place, edge);
    add(first, edge);
    sums_->edge(sq.place, sb.place, second);
    sums_->edge(sb.place, sp.place, edge);
    add(second, edge);
    sums_->edge(sq.place, sp.place, edge);
    add(first, edge);
    subtract(second, edge);
    flip.first = corner_fit(first, sp.place, sa, sq).error(sp.color);
    flip.second = corner_fit(second, sq.place, sb, sp).error(sq.color);
    flip.cost = flip.first + flip.second - error_[flip.f] - error_[flip.g];
    if (!(weights_.edge_cost > 0)) return true;
    int odd = is_odd(sp.place, sq.place, sa.place, sb.place) - is_odd(sa.place, sb.place, sp.place, sq.place);
    // The edges around both faces lose one corner across and gain another one.
    const auto outer = [&](Id f, Id from, Id to, const Place& before, const Place& after) {
        const std::size_t i =
            corner_of(mesh_.face(f), mesh_.face(f)[0] != from && mesh_.face(f)[0] != to   ? mesh_.face(f)[0]
                                     : mesh_.face(f)[1] != from && mesh_.face(f)[1] != to ? mesh_.face(f)[1]
                                                                                          : mesh_.face(f)[2]);
        const Id beyond = mesh_.across(f, i);
        if (beyond == kNone) return;
        const Place& far = spot_[mesh_.apex(beyond, f)].place;
        odd += is_odd(spot_[from].place, spot_[to].place, after, far) -
               is_odd(spot_[from].place, spot_[to].place, before, far);
    };
    outer(flip.f, p, a, sb.place, sq.place);
    outer(flip.f, b, p, sa.place, sq.place);
    outer(flip.g, q, b, sa.place, sp.place);
    outer(flip.g, a, q, sb.place, sp.place);
    flip.cost += weights_.edge_cost * odd;
    return true;
}

bool GridState::do_flip(const Flip& flip) {
    if (!mesh_.may_flip(flip.f, flip.i)) return false;
    changed(flip.f);
    changed(flip.g);
    mesh_.flip(flip.f, flip.i);
    error_[flip.f] = flip.first;
    error_[flip.g] = flip.second;
    return true;
}

// Visits every edge of some faces with a later face, once.
template <class Accept>
void GridState::flip_where(const IdRange& faces, Accept&& accept) {
    for (Id f = faces.first; f < faces.second; ++f)
        for (std::size_t i = 0; i < 3 && mesh_.live_face(f); ++i) {
            Flip flip{f, mesh_.across(f, i), i};
            if (flip.g == kNone || flip.g < f) continue;
            if (cost_flip(flip) && accept(flip)) do_flip(flip);
        }
}

void GridState::flip_edges(const IdRange& faces) {
    flip_where(faces, [&](const Flip& flip) { return flip.cost < -1e-9 * (flip.first + flip.second); });
}

void GridState::anneal_flips(const IdRange& faces, double temperature, GridRandom& random) {
    flip_where(faces, [&](const Flip& flip) { return flip.cost < temperature * random.exponential(); });
}

}  // namespace imgmesh
