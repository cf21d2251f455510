// Insertions: a new vertex in the middle of a face or on an edge.
#include <algorithm>

#include "libcore/base/dot.h"
#include "libcore/base/for_each_id.h"
#include "libcore/refine/refiner.h"

namespace imgmesh {

// The colour of a vertex that no pixel touches is the drawing's.
constexpr double kPull = 1e-3;

void Refiner::try_insertion(Id f, int edge, const FaceTrial& trial, const HatSums& hat,
                            Insertion& best) const {
    const Vec3d he = hat.he.cast<double>();
    const double hh = hat.hh + kPull;
    const double most = dot(he, he) / hh;  // what the best colour gains
    const auto n = static_cast<std::size_t>(edge);
    const Id g = edge < 0 ? kNone : trial.across[n];
    Cost before;
    add_face(before, f);
    if (g != kNone) add_face(before, g);
    if (!(most + shape_unit_ * before.shape > best.gain)) return;
    Vec2f position;
    Vec3f color;
    std::array<Face, 4> faces;  // the new vertex is corner 0 of each
    std::size_t count = 3;
    if (edge < 0) {
        const auto [a, b, c] = mesh_.face(f);
        faces = {Face{kNone, a, b}, {kNone, b, c}, {kNone, c, a}};
        position = (vertex_.position[a] + vertex_.position[b] + vertex_.position[c]) / 3;
        color = (vertex_.color[a] + vertex_.color[b] + vertex_.color[c]) / 3;
        position = {snapped(position.x()), snapped(position.y())};
    } else {
        const float at = trial.at[n];
        const Face& face = mesh_.face(f);
        const Id o = face[n], p = face[(n + 1) % 3], q = face[(n + 2) % 3];
        faces = {Face{kNone, o, p}, {kNone, q, o}};
        count = 2;
        const Vec2f middle = (1 - at) * vertex_.position[p] + at * vertex_.position[q];
        color = (1 - at) * vertex_.color[p] + at * vertex_.color[q];
        const std::uint8_t side = g == kNone ? vertex_.fixed[p] & vertex_.fixed[q] : RefineVertices::kFree;
        position = {side == kFixedX ? vertex_.position[p].x() : snapped(middle.x()),
                    side == kFixedY ? vertex_.position[p].y() : snapped(middle.y())};
        if (g != kNone) {
            const Id r = mesh_.apex(g, f);
            faces[2] = {kNone, p, r};
            faces[3] = {kNone, r, q};
            count = 4;
        }
    }
    Cost after;
    for (std::size_t k = 0; k < count && after.legal; ++k)
        add_shape(after, position, vertex_.position[faces[k][1]], vertex_.position[faces[k][2]]);
    if (!after.legal || too_thin(after, before)) return;
    const double shape = shape_unit_ * (before.shape - after.shape);
    if (!(most + shape > best.gain)) return;
    const Vec3f chosen = allowed(color - (he / hh).cast<float>());
    const Vec3d change = (chosen - color).cast<double>();
    const double gain = shape - 2 * dot(change, he) - hat.hh * dot(change, change);
    if (gain > best.gain) best = {f, edge, position, chosen, gain, edge >= 0 && count == 2};
}

Refiner::Insertion Refiner::best_insertion(const std::vector<FaceTrial>& trials, const TouchedFaces& touched,
                                           Id f) const {
    Insertion best{f, -1, {}, {}, 0, false};
    if (!mesh_.live_face(f) || touched.has(f)) return best;
    const FaceTrial& trial = trials[f];
    try_insertion(f, -1, trial, trial.hats.center, best);
    for (std::size_t n = 0; n < 3; ++n) {
        const Id g = trial.across[n];
        if (g == kNone) {
            // A border edge only if it is on a side.
            const std::uint8_t side =
                vertex_.fixed[mesh_.face(f)[(n + 1) % 3]] & vertex_.fixed[mesh_.face(f)[(n + 2) % 3]];
            if (side != kFixedX && side != kFixedY) continue;
        } else {
            // Inner edges are tried once.
            if (g < f || touched.has(g)) continue;
        }
        try_insertion(f, static_cast<int>(n), trial, trial.hats.edge[n], best);
    }
    return best;
}

std::vector<Refiner::Insertion> Refiner::insertions(const std::vector<FaceTrial>& trials,
                                                    const TouchedFaces& touched) const {
    std::vector<Insertion> all(mesh_.faces().size());
    for_each_id(all.size(), [&](Id f) { all[f] = best_insertion(trials, touched, f); });
    std::erase_if(all, [](const Insertion& insertion) { return !(insertion.gain > 0); });
    std::sort(all.begin(), all.end(), [](const Insertion& a, const Insertion& b) {
        return a.gain != b.gain ? a.gain > b.gain : a.face < b.face;
    });
    return all;
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
    sums_.resize(mesh_.faces().size());
    inverse_q_.resize(mesh_.faces().size());
    OneRing ring;
    mesh_.ring(v, ring);
    changed(ring);
    return v;
}

Id Refiner::across(const Insertion& insertion) const {
    return insertion.edge < 0 ? kNone
                              : mesh_.across(insertion.face, static_cast<std::size_t>(insertion.edge));
}

}  // namespace imgmesh
