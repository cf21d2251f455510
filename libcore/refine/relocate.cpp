// Relocation: vertices move from where their loss costs least to where another one gains most.
#include <algorithm>
#include <cmath>

#include "libcore/base/for_each_id.h"
#include "libcore/refine/refiner.h"

namespace imgmesh {

// Of the vertices that seem to cost least, so many times more are looked at than are removed. With twice as
// many the RMS of the default preset is .14 % higher, with three times .03 %, with all of them the same.
constexpr std::size_t kLookedAt = 4;

void Refiner::move(const std::vector<Id>& vertices) {
    for_each_id(vertices.size(), [&](Id k) { move_vertex(vertices[k]); });
}

std::vector<Id> Refiner::faces_around(const std::vector<Id>& vertices) const {
    std::vector<Id> faces;
    OneRing ring;
    for (const Id v : vertices)
        if (mesh_.ring(v, ring))
            faces.insert(faces.end(), ring.face.begin(),
                         ring.face.begin() + static_cast<std::ptrdiff_t>(ring.faces));
    return faces;
}

Refiner::Rewired Refiner::flip_and_relocate() {
    const auto most =
        static_cast<std::size_t>(std::ceil(params_.relocations * static_cast<double>(mesh_.live_vertices())));
    const std::vector<FaceTrial> trials = this->trials();
    // What was found for a face or a vertex holds only until something near it changes.
    TouchedFaces touched(trials.size());
    Rewired done;
    done.flips = flip_edges(trials, touched);
    const std::vector<Insertion> insertions = this->insertions(trials, touched);
    const std::vector<Removal> removals = this->removals(kLookedAt * most);
    touched = TouchedFaces(trials.size());
    std::vector<Id> fresh;
    // Inner vertices are exchanged for inner ones, so the number of faces stays.
    for (const bool border : {false, true}) relocate(most, removals, insertions, border, touched, fresh);
    measure_changed();
    move(fresh);
    done.flips += static_cast<std::int64_t>(flip_near(faces_around(fresh)).size() / 2);
    done.relocations = static_cast<std::int64_t>(fresh.size());
    return done;
}

void Refiner::relocate(std::size_t most, const std::vector<Removal>& removals,
                       const std::vector<Insertion>& insertions, bool border, TouchedFaces& touched,
                       std::vector<Id>& fresh) {
    OneRing ring;
    std::size_t next_removal = 0;
    for (const Insertion& insertion : insertions) {
        if (fresh.size() >= most) return;
        const Id g = across(insertion);
        if (insertion.border != border || touched.has(insertion.face) || touched.has(g)) continue;
        // The cheapest removal whose ring neither was touched nor holds the insertion.
        bool found = false;
        while (next_removal < removals.size() && !found) {
            const Removal& removal = removals[next_removal++];
            if (!(insertion.gain > removal.cost)) return;
            if (removal.border != border) continue;
            mesh_.ring(removal.v, ring);
            found = !touched.has_any(ring) && mesh_.may_collapse(ring, removal.into);
            for (std::size_t k = 0; k < ring.faces; ++k)
                found = found && ring.face[k] != insertion.face && ring.face[k] != g;
            if (!found) continue;
            touched.add(ring);
            remove(removal);
            fresh.push_back(insert(insertion));
            mesh_.ring(fresh.back(), ring);
            touched.add(ring);
        }
    }
}

}  // namespace imgmesh
