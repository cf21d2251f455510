// Flips: an edge is exchanged for the other diagonal of its two faces.
//
// The drawings with one diagonal and with the other differ by a multiple of one hat, which is 1 where they
// cross: so the error of both follows from the sums of that hat. They also say what a vertex there gains.
#include <algorithm>

#include "libcore/base/dot.h"
#include "libcore/base/for_each_id.h"
#include "libcore/refine/refiner.h"

namespace imgmesh {

Refiner::Cost Refiner::flip_shapes(Id f, std::size_t i, Id g) const {
    const Face& face = mesh_.face(f);
    const Vec2f &p = vertex_.position[face[i]], &a = vertex_.position[face[(i + 1) % 3]],
                &b = vertex_.position[face[(i + 2) % 3]], &q = vertex_.position[mesh_.apex(g, f)];
    Cost cost;
    add_shape(cost, p, a, q);
    add_shape(cost, q, b, p);
    return cost;
}

// Says where the edge opposite corner i of f is divided. Each inner edge is handled once, for both faces.
void Refiner::divide_edge(Id f, std::size_t i, std::vector<FaceTrial>& trials) const {
    const Face& face = mesh_.face(f);
    if (face[(i + 1) % 3] > face[(i + 2) % 3]) return;
    const Id g = mesh_.across(f, i);
    if (g == kNone) return;
    const Id apex = mesh_.apex(g, f);
    const std::size_t j = corner_of(mesh_.face(g), apex);
    trials[f].across[i] = g;
    trials[g].across[j] = f;
    const bool legal = flip_shapes(f, i, g).legal;
    trials[f].may_flip[i] = trials[g].may_flip[j] = legal;
    if (!legal) return;
    const Vec2f &p = vertex_.position[face[i]], &a = vertex_.position[face[(i + 1) % 3]],
                &b = vertex_.position[face[(i + 2) % 3]], &q = vertex_.position[apex];
    const double beside_a = signed_area2(p, a, q), beside_b = signed_area2(q, b, p);
    trials[f].at[i] = static_cast<float>(beside_a / (beside_a + beside_b));
    trials[g].at[j] = 1 - trials[f].at[i];
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
    for_each_id(out.size(), [&](Id f) {
        for (std::size_t i = 0; i < 3 && mesh_.live_face(f); ++i) {
            const Id g = out[f].across[i];
            if (g == kNone || g < f) continue;
            const std::size_t j = corner_of(mesh_.face(g), mesh_.apex(g, f));
            out[f].hats.edge[i].hh += out[g].hats.edge[j].hh;
            out[f].hats.edge[i].he += out[g].hats.edge[j].he;
        }
    });
    return out;
}

bool Refiner::flip_seems_better(const std::vector<FaceTrial>& trials, Id f, std::size_t i) const {
    const FaceTrial& trial = trials[f];
    const Id g = trial.across[i];
    if (!trial.may_flip[i] || g < f) return false;
    const Face& face = mesh_.face(f);
    const Id p = face[i], a = face[(i + 1) % 3], b = face[(i + 2) % 3], q = mesh_.apex(g, f);
    const double beside_p = signed_area2(vertex_.position[p], vertex_.position[a], vertex_.position[b]),
                 beside_q = signed_area2(vertex_.position[q], vertex_.position[b], vertex_.position[a]);
    const float s = static_cast<float>(beside_p / (beside_p + beside_q)), t = trial.at[i];
    const Vec3f now = (1 - t) * vertex_.color[a] + t * vertex_.color[b],
                flipped = (1 - s) * vertex_.color[p] + s * vertex_.color[q];
    const Vec3d change = (flipped - now).cast<double>();
    const HatSums& hat = trial.hats.edge[i];
    const double growth = 2 * dot(change, Vec3d(hat.he.cast<double>())) + hat.hh * dot(change, change);
    Cost before;
    add_face(before, f);
    add_face(before, g);
    if (growth > shape_unit_ * before.shape) return false;
    Cost after = flip_shapes(f, i, g);
    after.error = before.error + growth;
    return better(after, before);
}

bool Refiner::flip_is_better(const Edge& edge) const {
    const auto [f, i] = edge;
    const Face& face = mesh_.face(f);
    const Id g = mesh_.across(f, i), q = mesh_.apex(g, f);
    Cost before, after = flip_shapes(f, i, g);
    if (!after.legal) return false;
    add_face(before, f);
    add_face(before, g);
    after.error = face_error({face[i], face[(i + 1) % 3], q}) + face_error({q, face[(i + 2) % 3], face[i]});
    return better(after, before);
}

// One after the other, except where a face has flipped already. Returns both faces of each.
std::vector<Id> Refiner::flip(const std::vector<Edge>& edges) {
    TouchedFaces touched(mesh_.faces().size());
    std::vector<Id> flipped;
    for (const auto& [f, i] : edges) {
        if (touched.has(f)) continue;
        const Id g = mesh_.across(f, i);
        if (touched.has(g) || !mesh_.may_flip(f, i)) continue;
        mesh_.flip(f, i);
        for (const Id face : {f, g}) {
            touched.add(face);
            changed(face);
            flipped.push_back(face);
        }
    }
    measure_changed();
    return flipped;
}

std::vector<Id> Refiner::flip_near(std::vector<Id> faces) {
    // What flips after four passes hardly matters.
    constexpr int kPasses = 4;
    std::vector<Id> all;
    for (int pass = 0; pass < kPasses && !faces.empty(); ++pass) {
        std::vector<Edge> edges;  // each once, in the face of the lower number
        for (const Id f : faces)
            for (std::size_t i = 0; i < 3; ++i) {
                const Id g = mesh_.across(f, i);
                if (g == kNone) continue;
                edges.push_back(f < g ? Edge{f, i} : Edge{g, corner_of(mesh_.face(g), mesh_.apex(g, f))});
            }
        std::sort(edges.begin(), edges.end());
        edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
        std::vector<std::uint8_t> worthwhile(edges.size());
        for_each_id(edges.size(), [&](Id k) { worthwhile[k] = flip_is_better(edges[k]); });
        std::vector<Edge> chosen;
        for (std::size_t k = 0; k < edges.size(); ++k)
            if (worthwhile[k]) chosen.push_back(edges[k]);
        faces = flip(chosen);
        all.insert(all.end(), faces.begin(), faces.end());
    }
    return all;
}

std::int64_t Refiner::flip_edges() {
    TouchedFaces touched(mesh_.faces().size());
    return flip_edges(trials(), touched);
}

std::int64_t Refiner::flip_edges(const std::vector<FaceTrial>& trials, TouchedFaces& touched) {
    const std::size_t faces = mesh_.faces().size();
    std::vector<std::array<std::uint8_t, 3>> worthwhile(faces);
    for_each_id(faces, [&](Id f) {
        for (std::size_t i = 0; i < 3; ++i)
            worthwhile[f][i] = mesh_.live_face(f) && flip_seems_better(trials, f, i);
    });
    std::vector<Edge> edges;
    for (Id f = 0; f < faces; ++f)
        for (std::size_t i = 0; i < 3; ++i)
            if (worthwhile[f][i]) edges.push_back({f, i});
    std::vector<Id> flipped = flip(edges);
    const std::vector<Id> later = flip_near(flipped);
    flipped.insert(flipped.end(), later.begin(), later.end());
    for (const Id f : flipped) touched.add(f);
    return static_cast<std::int64_t>(flipped.size() / 2);
}

}  // namespace imgmesh
