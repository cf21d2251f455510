#include "libcore/warp/mesh_parts.h"

#include <cmath>

namespace imgmesh {

MeshParts::MeshParts(const BaseMesh& mesh) {
    std::vector<Id> parent(mesh.vertex_count());
    for (Id v = 0; v < parent.size(); ++v) parent[v] = v;
    const auto root = [&](Id v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const auto& [a, b, c] : mesh.faces) {
        if (!(signed_area2(mesh.position[a], mesh.position[b], mesh.position[c]) > 0)) continue;
        parent[root(a)] = root(b);
        parent[root(b)] = root(c);
    }
    std::vector<Id> number(parent.size(), kNone);
    for (Id v = 0; v < parent.size(); ++v) {
        Id& n = number[root(v)];
        if (n == kNone) n = count_++;
        part_.push_back(n);
    }
}

std::vector<bool> MeshParts::vertices_with(const std::vector<Id>& vertices) const {
    std::vector<bool> reached(count_, false), all;
    for (const Id v : vertices) reached[part_[v]] = true;
    for (const Id part : part_) all.push_back(reached[part]);
    return all;
}

void MeshParts::move_rigidly(const std::vector<Vec2d>& rest, const std::vector<Id>& fixed,
                             const std::vector<Vec2d>& target, std::vector<Vec2d>& place) const {
    struct Sums {
        double count = 0, dot = 0, cross = 0;
        Vec2d from{0, 0}, to{0, 0};
    };
    std::vector<Sums> sums(count_);
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        Sums& s = sums[part_[fixed[i]]];
        s.count += 1;
        s.from += rest[fixed[i]];
        s.to += target[i];
    }
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        Sums& s = sums[part_[fixed[i]]];
        const Vec2d a = rest[fixed[i]] - s.from / s.count, b = target[i] - s.to / s.count;
        s.dot += a.dot(b);
        s.cross += a.x() * b.y() - a.y() * b.x();
    }
    for (Id v = 0; v < place.size(); ++v) {
        const Sums& s = sums[part_[v]];
        if (s.count == 0) continue;
        const double length = std::sqrt(s.dot * s.dot + s.cross * s.cross);
        const double cosine = length > 0 ? s.dot / length : 1, sine = length > 0 ? s.cross / length : 0;
        const Vec2d d = rest[v] - s.from / s.count;
        place[v] = s.to / s.count + Vec2d(cosine * d.x() - sine * d.y(), sine * d.x() + cosine * d.y());
    }
    for (std::size_t i = 0; i < fixed.size(); ++i) place[fixed[i]] = target[i];
}

}  // namespace imgmesh
