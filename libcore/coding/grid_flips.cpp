// Flips of edges.
#include "libcore/coding/grid_state.h"

namespace imgmesh {

bool GridState::cost_flip(Flip& flip) const {
    const Face& face = mesh_.face(flip.f);
    const Id p = face[flip.i], a = face[(flip.i + 1) % 3], b = face[(flip.i + 2) % 3];
    const Id q = mesh_.apex(flip.g, flip.f);
    const Spot &sp = spot_[p], &sa = spot_[a], &sb = spot_[b], &sq = spot_[q];
    if (area2(sp.place, sa.place, sq.place) <= 0 || area2(sq.place, sb.place, sp.place) <= 0) return false;
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
