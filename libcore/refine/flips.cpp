// Flips: an edge is exchanged for the other diagonal of its two faces.
//
// The drawings with one diagonal and with the other differ by a multiple of one hat, which is 1 where they
// cross: so the error of both follows from the sums of that hat. They also say what a vertex there gains.
#include "libcore/base/dot.h"
#include "libcore/base/for_each_id.h"
#include "libcore/refine/refiner.h"

namespace imgmesh {

void Refiner::flip_shapes(Id f, std::size_t i, Id g, Cost& before, Cost& after) const {
    const Id p = mesh_.face(f)[i], a = mesh_.face(f)[(i + 1) % 3], b = mesh_.face(f)[(i + 2) % 3];
    const Id q = mesh_.apex(g, f);
    add_shape(after, vertex_.position[p], vertex_.position[a], vertex_.position[q]);
    add_shape(after, vertex_.position[q], vertex_.position[b], vertex_.position[p]);
    if (!after.legal) return;
    add_shape(before, vertex_.position[p], vertex_.position[a], vertex_.position[b]);
    add_shape(before, vertex_.position[q], vertex_.position[b], vertex_.position[a]);
}

// Says where the edge opposite corner i of f is divided. Each inner edge is handled once, for both faces.
void Refiner::divide_edge(Id f, std::size_t i, std::vector<FaceTrial>& trials) const {
    FaceTrial& trial = trials[f];
    const Id g = trial.across[i] = mesh_.across(f, i);
    trial.may_flip[i] = false;
    if (g == kNone) trial.at[i] = 0.5f;
    if (g == kNone || g < f) return;
    const Face& face = mesh_.face(f);
    const Id q = mesh_.apex(g, f);
    const Vec2f &p = vertex_.position[face[i]], &a = vertex_.position[face[(i + 1) % 3]],
                &b = vertex_.position[face[(i + 2) % 3]], &r = vertex_.position[q];
    Cost flipped;
    add_shape(flipped, p, a, r);
    add_shape(flipped, r, b, p);
    const double beside_a = signed_area2(p, a, r), beside_b = signed_area2(r, b, p);
    trial.may_flip[i] = flipped.legal;
    trial.at[i] = flipped.legal ? static_cast<float>(beside_a / (beside_a + beside_b)) : 0.5f;
    trials[g].at[corner_of(mesh_.face(g), q)] = 1 - trial.at[i];
}

std::vector<Refiner::FaceTrial> Refiner::trials() const {
    std::vector<FaceTrial> out(mesh_.faces().size());
    for_each_id(out.size(), [&](Id f) {
        for (std::size_t i = 0; i < 3 && mesh_.live_face(f); ++i) divide_edge(f, i, out);
    });
    for_each_id(out.size(), [&](Id f) {
        if (!mesh_.live_face(f)) return;
        const auto [a, b, c] = mesh_.face(f);
        out[f].hats = face_hats(image_, corner(a), corner(b), corner(c), out[f].at);
    });
    return out;
}

HatSums Refiner::edge_hat(const std::vector<FaceTrial>& trials, Id f, std::size_t i) const {
    HatSums hat = trials[f].hats.edge[i];
    const Id g = trials[f].across[i];
    if (g == kNone) return hat;
    const HatSums& other = trials[g].hats.edge[corner_of(mesh_.face(g), mesh_.apex(g, f))];
    hat.hh += other.hh;
    hat.he += other.he;
    return hat;
}

bool Refiner::flip_seems_better(const std::vector<FaceTrial>& trials, Id f, std::size_t i) const {
    const FaceTrial& trial = trials[f];
    if (!trial.may_flip[i]) return false;
    const Id g = trial.across[i];
    const Face& face = mesh_.face(f);
    const Id p = face[i], a = face[(i + 1) % 3], b = face[(i + 2) % 3], q = mesh_.apex(g, f);
    const double beside_p = signed_area2(vertex_.position[p], vertex_.position[a], vertex_.position[b]),
                 beside_q = signed_area2(vertex_.position[q], vertex_.position[b], vertex_.position[a]);
    const float s = static_cast<float>(beside_p / (beside_p + beside_q)), t = trial.at[i];
    const Vec3f now = (1 - t) * vertex_.color[a] + t * vertex_.color[b],
                flipped = (1 - s) * vertex_.color[p] + s * vertex_.color[q];
    const Vec3d change = (flipped - now).cast<double>();
    const HatSums hat = edge_hat(trials, f, i);
    Cost before, after;
    before.error = sums_[f].ee + sums_[g].ee;
    after.error = before.error + 2 * dot(change, hat.he) + hat.hh * dot(change, change);
    flip_shapes(f, i, g, before, after);
    return better(after, before);
}

bool Refiner::flip_if_better(Id f, std::size_t i, Id g) {
    const Id p = mesh_.face(f)[i], a = mesh_.face(f)[(i + 1) % 3], b = mesh_.face(f)[(i + 2) % 3];
    const Id q = mesh_.apex(g, f);
    Cost before, after;
    flip_shapes(f, i, g, before, after);
    if (!after.legal) return false;
    const FaceSums first = sums_of({p, a, q}), second = sums_of({q, b, p});
    before.error = sums_[f].ee + sums_[g].ee;
    after.error = first.ee + second.ee;
    if (!better(after, before) || !mesh_.may_flip(f, i)) return false;
    mesh_.flip(f, i);
    sums_[f] = first;
    sums_[g] = second;
    changed(f);
    changed(g);
    return true;
}

// The edges around v, opposite it and at it.
std::int64_t Refiner::flip_around(Id v) {
    OneRing ring;
    if (!mesh_.ring(v, ring)) return 0;
    std::int64_t flips = 0;
    for (std::size_t k = 0; k < ring.faces; ++k) {
        const Id f = ring.face[k];
        const auto tried = [&](std::size_t turn) {
            const std::size_t i = (corner_of(mesh_.face(f), v) + turn) % 3;
            const Id g = mesh_.face(f)[(i + 3 - turn) % 3] == v ? mesh_.across(f, i) : kNone;
            return g != kNone && flip_if_better(f, i, g);
        };
        flips += tried(0);
        flips += tried(1);
    }
    return flips;
}

std::int64_t Refiner::flip_edges() {
    TouchedFaces touched(mesh_.faces().size());
    return flip_edges(trials(), touched);
}

// All threads compute the effects of flips. They hold for pairs of faces that no earlier flip has changed, so
// the outcome is that of one edge after the other.
std::int64_t Refiner::flip_edges(const std::vector<FaceTrial>& trials, TouchedFaces& touched) {
    const std::size_t faces = mesh_.faces().size();
    std::vector<std::array<std::uint8_t, 3>> worthwhile(faces);
    for_each_id(faces, [&](Id f) {
        for (std::size_t i = 0; i < 3; ++i)
            worthwhile[f][i] = mesh_.live_face(f) && flip_seems_better(trials, f, i);
    });
    std::int64_t flips = 0;
    for (Id f = 0; f < faces; ++f) {
        if (!mesh_.live_face(f)) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            Id g = trials[f].across[i];
            const bool is_new = touched.has(f) || touched.has(g);
            if (is_new) g = mesh_.across(f, i);
            if (g == kNone || f > g || !(worthwhile[f][i] || is_new) || !flip_if_better(f, i, g)) continue;
            touched.add(f);
            touched.add(g);
            ++flips;
        }
    }
    return flips;
}

}  // namespace imgmesh
