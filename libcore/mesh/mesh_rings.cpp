#include "libcore/mesh/mesh_rings.h"

#include <deque>

#include "libcore/base/error.h"
#include "libcore/mesh/fan_chain.h"

namespace imgmesh {
namespace {

// The faces at each vertex, ascending at first.
std::vector<std::vector<Id>> faces_by_vertex(const BaseMesh& mesh) {
    std::vector<std::vector<Id>> at(mesh.vertex_count());
    for (Id f = 0; f < mesh.faces.size(); ++f)
        for (const Id v : mesh.faces[f]) at[v].push_back(f);
    return at;
}

// Leaves the faces of one fan in `faces` and returns the others.
std::vector<Id> beside_one_fan(const BaseMesh& mesh, Id v, std::vector<Id>& faces) {
    const std::vector<Id> chain = fan_chain(mesh, v, faces);
    const auto in_fan = [&](Id f) {
        const Face& face = mesh.faces[f];
        const Id from = face[(corner_of(face, v) + 1) % 3];
        return std::find(chain.begin(), chain.end(), from) != chain.end();
    };
    std::vector<Id> others;
    std::copy_if(faces.begin(), faces.end(), std::back_inserter(others), [&](Id f) { return !in_fan(f); });
    std::erase_if(faces, [&](Id f) { return !in_fan(f); });
    return others;
}

void split_fans(BaseMesh& mesh, std::vector<std::vector<Id>>& at) {
    for (Id v = 0; v < at.size(); ++v) {
        if (at[v].empty()) continue;
        std::vector<Id> others = beside_one_fan(mesh, v, at[v]);
        if (others.empty()) continue;
        const auto copy = static_cast<Id>(mesh.vertex_count());
        mesh.position.push_back(Vec2f(mesh.position[v]));
        for (int c = 0; c < mesh.channels; ++c) mesh.feature.push_back(mesh.feature_of(v)[c]);
        for (const Id f : others) mesh.faces[f][corner_of(mesh.faces[f], v)] = copy;
        at.push_back(std::move(others));  // and is looked at in its turn
    }
}

// Flips edges at vertices with too many neighbours.
class ValenceLimit {
  public:
    ValenceLimit(BaseMesh& mesh, std::vector<std::vector<Id>>& at) : mesh_(mesh), at_(at) {
        for (Id v = 0; v < at.size(); ++v) {
            const std::size_t chain = at[v].empty() ? 0 : fan_chain(mesh, v, at[v]).size();
            open_.push_back(chain > at[v].size());
            if (chain > kMost) waiting_.push_back(v);
        }
    }

    void run() {
        // Each flip takes an edge from a vertex that has too many; neighbours rarely come to have too many.
        std::size_t left = 64 * (waiting_.size() + 16);
        while (!waiting_.empty()) {
            const Id v = waiting_.front();
            waiting_.pop_front();
            while (valence(v) > kMost)
                if (left-- == 0 || !(flip_one(v) || split(v)))
                    throw Error(ErrorKind::kUnsupported, cat("vertex ", v, " has ", valence(v),
                                                             " neighbours, expected at most ", kMost));
        }
    }

  private:
    static constexpr std::size_t kMost = kMaxValence;

    std::size_t valence(Id v) const { return at_[v].size() + open_[v]; }

    // Flips the edge that leaves the best triangles, if there is one whose flip makes too many neighbours
    // nowhere.
    bool flip_one(Id v) {
        const std::vector<Id> chain = fan_chain(mesh_, v, at_[v]);
        const std::size_t n = chain.size();
        double best = 0;
        std::size_t corner = n;
        for (std::size_t k = open_[v]; k + open_[v] < n; ++k) {
            const Id a = chain[(k + n - 1) % n], b = chain[k], c = chain[(k + 1) % n];
            const double shape = std::min(corner_shape(mesh_, a, b, c), corner_shape(mesh_, v, a, c));
            if (shape <= best || valence(a) >= kMost || valence(c) >= kMost) continue;
            best = shape;
            corner = k;
        }
        if (corner == n) return false;
        flip(v, chain[(corner + n - 1) % n], chain[corner], chain[(corner + 1) % n]);
        return true;
    }

    // Gives half of the edges to a new vertex beside v, where no edge can be flipped: beside a long edge of
    // the boundary its ends alone are seen.
    bool split(Id v) {
        const std::vector<Id> chain = fan_chain(mesh_, v, at_[v]);
        // Seen from v, the new vertex lies among the neighbours that it takes: less than half a turn.
        const std::size_t count = chain.size() / 2 + 1,
                          ways = open_[v] ? chain.size() - count + 1 : chain.size();
        for (std::size_t first = 0; first < ways; ++first) {
            std::vector<Id> taken;
            for (std::size_t k = 0; k < count; ++k) taken.push_back(chain[(first + k) % chain.size()]);
            Vec2f middle = Vec2f::Zero();
            for (const Id n : taken)
                middle += (mesh_.position[n] - mesh_.position[v]) / static_cast<float>(count);
            for (float share = 0.5f; share > 1e-3f; share /= 2)
                if (split(v, taken, mesh_.position[v] + share * middle)) return true;
        }
        return false;
    }
    bool split(Id v, const std::vector<Id>& taken, const Vec2f& place) {
        const auto at = [&](Id n) { return mesh_.position[n]; };
        if (!(signed_area2(at(v), at(taken.front()), place) > 0) ||
            !(signed_area2(at(v), place, at(taken.back())) > 0))
            return false;
        for (std::size_t k = 0; k + 1 < taken.size(); ++k)
            if (!(signed_area2(place, at(taken[k]), at(taken[k + 1])) > 0)) return false;
        const Id added = as_id(mesh_.vertex_count());
        const std::vector<float> feature = feature_at(v, taken, place);
        mesh_.position.push_back(place);
        mesh_.feature.insert(mesh_.feature.end(), feature.begin(), feature.end());
        at_.emplace_back();
        open_.push_back(false);
        for (std::size_t k = 0; k + 1 < taken.size(); ++k) {
            const Id f = face_with(v, taken[k]);
            mesh_.faces[f] = {added, taken[k], taken[k + 1]};
            std::erase(at_[v], f);
            at_[added].push_back(f);
        }
        for (const Face& face : {Face{v, taken.front(), added}, Face{v, added, taken.back()}}) {
            const Id f = as_id(mesh_.faces.size());
            mesh_.faces.push_back(face);
            for (const Id corner : face) at_[corner].push_back(f);
        }
        for (const Id n : {taken.front(), taken.back(), added})
            if (valence(n) > kMost) waiting_.push_back(n);
        return true;
    }
    // What the mesh has at a place in one of the faces between v and the neighbours taken.
    std::vector<float> feature_at(Id v, const std::vector<Id>& taken, const Vec2f& place) const {
        std::vector<float> feature(mesh_.feature_of(v), mesh_.feature_of(v) + mesh_.channels);
        for (std::size_t k = 0; k + 1 < taken.size(); ++k) {
            const Vec2f &o = mesh_.position[v], &a = mesh_.position[taken[k]],
                        &b = mesh_.position[taken[k + 1]];
            const double all = signed_area2(o, a, b), u = signed_area2(o, place, b) / all,
                         w = signed_area2(o, a, place) / all;
            if (u < 0 || w < 0) continue;
            for (int c = 0; c < mesh_.channels; ++c)
                feature[as_index(c)] = static_cast<float>((1 - u - w) * double{mesh_.feature_of(v)[c]} +
                                                          u * double{mesh_.feature_of(taken[k])[c]} +
                                                          w * double{mesh_.feature_of(taken[k + 1])[c]});
            break;
        }
        return feature;
    }

    // Faces (v, a, b) and (v, b, c) become (a, b, c) and (v, a, c).
    void flip(Id v, Id a, Id b, Id c) {
        const Id first = face_with(v, a), second = face_with(v, b);
        mesh_.faces[first] = {a, b, c};
        mesh_.faces[second] = {v, a, c};
        std::erase(at_[v], first);
        std::erase(at_[b], second);
        at_[a].push_back(second);
        at_[c].push_back(first);
        for (const Id w : {a, c})
            if (valence(w) > kMost) waiting_.push_back(w);
    }

    // The face at v whose next corner is `after`.
    Id face_with(Id v, Id after) const {
        return *std::find_if(at_[v].begin(), at_[v].end(), [&](Id f) {
            const Face& face = mesh_.faces[f];
            return face[(corner_of(face, v) + 1) % 3] == after;
        });
    }

    BaseMesh& mesh_;
    std::vector<std::vector<Id>>& at_;
    std::vector<bool> open_;  // whether the vertex is on the boundary
    std::deque<Id> waiting_;  // with too many neighbours
};

// What a vertex on the boundary keeps, between its neighbours along it.
std::uint8_t kept_axes(const Vec2f& at, const Vec2f& before, const Vec2f& after, const Vec2f& corner) {
    const auto along = [](float p, float q, float r, float last) {
        return p == q && p == r && (p == 0 || p == last);
    };
    if (along(at.x(), before.x(), after.x(), corner.x())) return kFixedX;
    if (along(at.y(), before.y(), after.y(), corner.y())) return kFixedY;
    return kFixedX | kFixedY;
}

}  // namespace

void fit_for_rings(BaseMesh& mesh) {
    std::vector<std::vector<Id>> at = faces_by_vertex(mesh);
    split_fans(mesh, at);
    ValenceLimit(mesh, at).run();
}

RingMesh mesh_rings(const BaseMesh& mesh, const Vec2f& corner) {
    const std::vector<std::vector<Id>> at = faces_by_vertex(mesh);
    RingMesh rings(mesh.vertex_count());
    for (Id v = 0; v < rings.size(); ++v) {
        Ring& ring = rings[v];
        ring.x = mesh.position[v].x();
        ring.y = mesh.position[v].y();
        if (at[v].empty()) continue;
        const std::vector<Id> chain = fan_chain(mesh, v, at[v]);
        std::copy(chain.begin(), chain.end(), ring.neighbor);
        ring.valence = static_cast<std::uint8_t>(chain.size());
        if (chain.size() > at[v].size())
            ring.fixed = kept_axes(mesh.position[v], mesh.position[chain.front()],
                                   mesh.position[chain.back()], corner);
    }
    return rings;
}

}  // namespace imgmesh
