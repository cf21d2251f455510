// Removals: half-edge collapses.
#include <algorithm>
#include <limits>
#include <utility>

#include "libcore/base/dot.h"
#include "libcore/base/for_each_id.h"
#include "libcore/refine/refiner.h"

namespace imgmesh {

// A vertex on a side moves only along that side.
bool Refiner::may_become(const OneRing& ring, std::size_t n) const {
    if (ring.closed) return true;
    const std::uint8_t fixed = vertex_.fixed[ring.center];
    return (n == 0 || n == ring.faces) && (vertex_.fixed[ring.vertex[n]] & fixed) == fixed;
}

// The shapes of the faces around u that take the place of a ring.
void Refiner::add_fan(Cost& cost, const OneRing& ring, Id u) const {
    for (std::size_t k = 0; k < ring.faces && cost.legal; ++k)
        if (!ring.has(k, u))
            add_shape(cost, vertex_.position[u], vertex_.position[ring.vertex[k]],
                      vertex_.position[ring.vertex[k + 1]]);
}

// The error is taken without a look at the pixels: as if only v got the colour that the new face has there,
// and its faces stayed as they are.
std::size_t Refiner::estimate(const OneRing& ring, Estimates& out) const {
    const Id v = ring.center;
    double ww = 0;
    Vec3d we = Vec3d::Zero();
    for (std::size_t k = 0; k < ring.faces; ++k) {
        const FaceSums& sums = sums_[ring.face[k]];
        ww += sums.square[ring.corner[k]];
        we += sums.we[ring.corner[k]].cast<double>();
    }
    const Vec2f center = vertex_.position[v];
    std::size_t count = 0;
    for (std::size_t n = 0; n < ring.vertices(); ++n) {
        const Id u = ring.vertex[n];
        if (!may_become(ring, n)) continue;
        // The ray from u through v leaves the ring between the vertices k and k + 1.
        const Vec2f from = vertex_.position[u];
        double side = 0, next = signed_area2(from, center, vertex_.position[ring.vertex[0]]);
        std::size_t k = 0;
        for (; k < ring.faces; ++k) {
            side = std::exchange(next, signed_area2(from, center, vertex_.position[ring.vertex[k + 1]]));
            if (!ring.has(k, u) && side <= 0 && next >= 0 && side < next) break;
        }
        if (k == ring.faces) continue;
        const Id b = ring.vertex[k], c = ring.vertex[k + 1];
        const double area2 = signed_area2(from, vertex_.position[b], vertex_.position[c]);
        const auto wb = static_cast<float>(next / area2), wc = static_cast<float>(-side / area2);
        const Vec3f color = (1 - wb - wc) * vertex_.color[u] + wb * vertex_.color[b] + wc * vertex_.color[c];
        const Vec3d change = (color - vertex_.color[v]).cast<double>();
        out[count++] = {2 * dot(change, we) + ww * dot(change, change), u};
    }
    return count;
}

// What the best removal of v seems to cost; infinite if it cannot be removed.
double Refiner::estimated_removal(Id v) const {
    double best = std::numeric_limits<double>::infinity();
    OneRing ring;
    if (!mesh_.live_vertex(v) || keeps_place(vertex_.fixed[v]) || !mesh_.ring(v, ring)) return best;
    const Cost before = cost_of(ring);
    Estimates estimates;
    const std::size_t count = estimate(ring, estimates);
    for (std::size_t n = 0; n < count; ++n) {
        const auto [error, u] = estimates[n];
        if (!(error - shape_unit_ * before.shape < best)) continue;
        Cost after;
        add_fan(after, ring, u);
        if (after.legal && !too_thin(after, before))
            best = std::min(best, error + shape_unit_ * (after.shape - before.shape));
    }
    return best;
}

// Half-edge collapse of v into the neighbour where the error grows least.
Refiner::Removal Refiner::best_removal(Id v) const {
    OneRing ring;
    mesh_.ring(v, ring);
    Removal best{v, kNone, std::numeric_limits<double>::infinity(), !ring.closed};
    const Cost before = cost_of(ring);
    // The one that seems best comes first: the sum of another stops when it exceeds the best so far.
    Estimates estimates;
    const std::size_t count = estimate(ring, estimates);
    std::sort(estimates.begin(), estimates.begin() + static_cast<std::ptrdiff_t>(count));
    // Those behind the third never matter: with one the RMS of the default preset is .1 % higher.
    constexpr int kTried = 3;
    int tried = 0;
    for (std::size_t n = 0; n < count && tried < kTried; ++n) {
        const Id u = estimates[n].second;
        Cost after;
        add_fan(after, ring, u);
        if (!after.legal || too_thin(after, before)) continue;
        ++tried;
        const double shape = shape_unit_ * (after.shape - before.shape);
        for (std::size_t k = 0; k < ring.faces && after.error - before.error + shape < best.cost; ++k)
            if (!ring.has(k, u)) after.error += face_error({u, ring.vertex[k], ring.vertex[k + 1]});
        const double cost = after.error - before.error + shape;
        if (cost < best.cost) {
            best.into = u;
            best.cost = cost;
        }
    }
    return best;
}

std::vector<Refiner::Removal> Refiner::removals(std::size_t some) const {
    std::vector<double> estimate(mesh_.vertices());
    for_each_id(estimate.size(), [&](Id v) { estimate[v] = estimated_removal(v); });
    std::vector<Id> candidates;
    for (Id v = 0; v < estimate.size(); ++v)
        if (estimate[v] < std::numeric_limits<double>::infinity()) candidates.push_back(v);
    if (some < candidates.size()) {
        std::nth_element(
            candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(some), candidates.end(),
            [&](Id a, Id b) { return estimate[a] != estimate[b] ? estimate[a] < estimate[b] : a < b; });
        candidates.resize(some);
    }
    std::vector<Removal> all(candidates.size());
    for_each_id(all.size(), [&](Id k) { all[k] = best_removal(candidates[k]); });
    std::erase_if(all, [](const Removal& removal) { return removal.into == kNone; });
    std::sort(all.begin(), all.end(), [](const Removal& a, const Removal& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.v < b.v;
    });
    return all;
}

void Refiner::remove(const Removal& removal) {
    OneRing ring;
    mesh_.ring(removal.v, ring);
    changed(ring);
    mesh_.collapse(ring, removal.into);
    // A removed face had one neighbour at v. The ring of their common vertex now begins with that neighbour.
    for (std::size_t k = 0; k < ring.faces; ++k) {
        const Id f = ring.face[k];
        if (mesh_.live_face(f))
            mesh_.begin_ring(removal.into, f);
        else if (ring.vertex[k] == removal.into)
            mesh_.begin_ring(ring.vertex[k + 1], ring.face[(k + 1) % ring.faces]);
        else
            mesh_.begin_ring(ring.vertex[k], ring.face[(k + ring.faces - 1) % ring.faces]);
    }
}

}  // namespace imgmesh
