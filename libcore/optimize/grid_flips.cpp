// Flips of edges.
#include "libcore/optimize/grid_state.h"

namespace imgmesh {

bool GridState::cost_flip(Flip& flip) const {
    const Face& face = mesh_.face(flip.f);
    const Id p = face[flip.i], a = face[(flip.i + 1) % 3], b = face[(flip.i + 2) % 3];
    const Id q = mesh_.apex(flip.g, flip.f);
    const Spot &sp = spot_[p], &sa = spot_[a], &sb = spot_[b], &sq = spot_[q];
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

bool GridState::do_flip(const Flip& flip) {
    if (!mesh_.may_flip(flip.f, flip.i)) return false;
    changed(flip.f);
    changed(flip.g);
    mesh_.flip(flip.f, flip.i);
    cost_[flip.f] = flip.first;
    cost_[flip.g] = flip.second;
    return true;
}

// Visits the edges of a face with later faces, once.
template <class Visit>
void GridState::for_each_flip(Id f, Visit&& visit) {
    for (std::size_t i = 0; i < 3 && mesh_.live_face(f); ++i) {
        Flip flip{f, mesh_.across(f, i), i};
        if (flip.g != kNone && flip.g > f) visit(flip);
    }
}

void GridState::flip_edges(const IdRange& faces) {
    for (Id f = faces.first; f < faces.second; ++f) {
        // Two faces that have not changed since then give the same answer.
        const std::uint64_t checked = face_[f].checked, now = tick_;
        bool refused = false;
        for_each_flip(f, [&](Flip& flip) {
            if (face_[f].changed <= checked && face_[flip.g].changed <= checked) return;
            if (cost_flip(flip) && flip.cost < -1e-9 * (flip.first + flip.second) && !do_flip(flip))
                refused = true;
        });
        face_[f].checked = refused ? 0 : now;
    }
}

void GridState::anneal_flips(const IdRange& faces, double temperature, GridRandom& random) {
    for (Id f = faces.first; f < faces.second; ++f)
        for_each_flip(f, [&](Flip& flip) {
            if (cost_flip(flip) && flip.cost < temperature * random.exponential()) do_flip(flip);
        });
}

}  // namespace imgmesh
