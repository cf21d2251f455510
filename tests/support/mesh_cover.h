// The area that a mesh covers, and the place of its boundary, found by examining every face.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh::test {

inline double distance_to_segment(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - t * (b - a)).norm();
}

using Segment = std::pair<Vec2d, Vec2d>;
inline std::vector<Segment> boundary(const BaseMesh& mesh) {
    std::map<std::pair<Id, Id>, int> faces;
    for (const auto& [a, b, c] : mesh.faces)
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            ++faces[std::minmax(p, q)];
    std::vector<Segment> out;
    for (const auto& [edge, count] : faces)
        if (count == 1)
            out.emplace_back(mesh.position[edge.first].cast<double>(),
                             mesh.position[edge.second].cast<double>());
    return out;
}

// Returns the largest distance to `to` from points of `from`, taken every quarter of a pixel.
inline double distance_from_to(const std::vector<Segment>& from, const std::vector<Segment>& to) {
    double largest = 0;
    for (const auto& [a, b] : from) {
        const int steps = static_cast<int>(std::ceil(4 * (b - a).norm()));
        for (int k = 0; k <= steps; ++k) {
            const Vec2d p = a + (b - a) * k / steps;
            double least = 1e9;
            for (const auto& [c, d] : to) least = std::min(least, distance_to_segment(p, c, d));
            largest = std::max(largest, least);
        }
    }
    return largest;
}

// Counts the faces over each point of a fine grid through which no edge runs (its offsets are practically
// irrational).
inline std::vector<int> faces_over_points(const BaseMesh& mesh, int width, int height) {
    std::vector<int> counts;
    for (double y = -1 + 0.14159265; y < height + 1; y += 0.2718281828)
        for (double x = -1 + 0.0577215664; x < width + 1; x += 0.2302585093)
            counts.push_back(
                static_cast<int>(std::count_if(mesh.faces.begin(), mesh.faces.end(), [&](const Face& f) {
                    const auto side = [&](Id p, Id q) {
                        const Vec2d a = mesh.position[p].cast<double>(), b = mesh.position[q].cast<double>();
                        return (b.y() - a.y()) * (x - a.x()) - (b.x() - a.x()) * (y - a.y()) > 0;
                    };
                    return side(f[0], f[1]) && side(f[1], f[2]) && side(f[2], f[0]);
                })));
    return counts;
}

inline bool covers(const BaseMesh& mesh, const Vec2d& p) {
    return std::any_of(mesh.faces.begin(), mesh.faces.end(), [&](const Face& f) {
        const auto side = [&](Id i, Id j) {
            const Vec2d a = mesh.position[i].cast<double>(), b = mesh.position[j].cast<double>();
            return (b.y() - a.y()) * (p.x() - a.x()) - (b.x() - a.x()) * (p.y() - a.y()) >= 0;  // exact
        };
        return side(f[0], f[1]) && side(f[1], f[2]) && side(f[2], f[0]);
    });
}

}  // namespace imgmesh::test
