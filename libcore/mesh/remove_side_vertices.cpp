// Steps: (1) the neighbours of a vertex that goes, in their order, are a chain from one along the side to the
// other; (2) corners of the chain are cut off, the best shaped first, until it is an edge. Seen from the
// vertex the chain never turns back, so a corner that is convex is a triangle of its own; the one farthest
// from the side always is.
#include "libcore/mesh/remove_side_vertices.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "libcore/mesh/fan_chain.h"

namespace imgmesh {
namespace {

class SideRemoval {
  public:
    SideRemoval(BaseMesh& mesh, const std::vector<Id>& gone)
        : mesh_(mesh), slot_(mesh.vertex_count(), kNone), faces_at_(gone.size()) {
        for (std::size_t n = 0; n < gone.size(); ++n) slot_[gone[n]] = static_cast<Id>(n);
        for (Id f = 0; f < mesh.faces.size(); ++f) attach(f);
    }

    void remove(Id v) {
        std::vector<Id> old = faces_at_[slot_[v]];
        std::vector<Id> chain = fan_chain(mesh_, v, old);
        for (const Id f : old) detach(f);
        while (chain.size() > 2) {
            const std::size_t k = best_corner(chain);
            const Id f = old.back();
            old.pop_back();
            mesh_.faces[f] = {chain[k - 1], chain[k], chain[k + 1]};
            attach(f);
            chain.erase(chain.begin() + static_cast<std::ptrdiff_t>(k));
        }
        for (const Id f : old) mesh_.faces[f][0] = kNone;
    }

    // What is left is numbered anew.
    void finish() {
        std::vector<Id> number(mesh_.vertex_count());
        const auto channels = static_cast<std::size_t>(mesh_.channels);
        Id count = 0;
        for (Id v = 0; v < number.size(); ++v) {
            if (slot_[v] != kNone) continue;
            mesh_.position[count] = mesh_.position[v];
            std::copy_n(mesh_.feature.data() + v * channels, channels,
                        mesh_.feature.data() + count * channels);
            number[v] = count++;
        }
        mesh_.position.resize(count);
        mesh_.feature.resize(count * channels);
        std::erase_if(mesh_.faces, [](const Face& face) { return face[0] == kNone; });
        for (Face& face : mesh_.faces)
            for (Id& v : face) v = number[v];
    }

  private:
    void attach(Id f) {
        for (const Id v : mesh_.faces[f])
            if (slot_[v] != kNone) faces_at_[slot_[v]].push_back(f);
    }
    void detach(Id f) {
        for (const Id v : mesh_.faces[f])
            if (slot_[v] != kNone) std::erase(faces_at_[slot_[v]], f);
    }

    // Of the inner ones of a chain, by twice the area over the square of the longest edge.
    std::size_t best_corner(const std::vector<Id>& chain) const {
        std::size_t best = 0;
        double best_shape = 0;
        for (std::size_t k = 1; k + 1 < chain.size(); ++k) {
            const double shape = corner_shape(mesh_, chain[k - 1], chain[k], chain[k + 1]);
            if (shape > best_shape) {
                best_shape = shape;
                best = k;
            }
        }
        assert(best > 0);
        return best;
    }

    BaseMesh& mesh_;
    std::vector<Id> slot_;                   // of each vertex that goes; kNone for others
    std::vector<std::vector<Id>> faces_at_;  // of each vertex that goes
};

}  // namespace

void remove_side_vertices(BaseMesh& mesh, const std::vector<Id>& gone) {
    if (gone.empty()) return;
    SideRemoval removal(mesh, gone);
    for (const Id v : gone) removal.remove(v);
    removal.finish();
}

}  // namespace imgmesh
