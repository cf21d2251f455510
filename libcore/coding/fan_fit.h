// The faces around one point as a function of the point's colour: a least-squares problem with one unknown.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "libcore/coding/row_sums.h"
#include "libcore/mesh/one_ring.h"

namespace imgmesh {

IMGMESH_INLINE double sum_lanes(const Double4& v) {
    return (v[0] + v[1]) + (v[2] + v[3]);
}

/// A vertex: where it is, and its colour with up to four channels.
struct Spot {
    Place place;
    Double4 color = {};
};

/// Returns twice the area of the triangle [quarter pixels^2], positive if counter-clockwise on screen.
IMGMESH_INLINE std::int64_t area2(const Place& a, const Place& b, const Place& c) {
    return std::int64_t{b.y - a.y} * (c.x - a.x) - std::int64_t{b.x - a.x} * (c.y - a.y);
}
IMGMESH_INLINE std::int64_t square(const Place& a, const Place& b) {
    const std::int64_t dx = b.x - a.x, dy = b.y - a.y;
    return dx * dx + dy * dy;
}
/// Returns whether a face is positive and not too thin: twice its area over the square of its longest edge.
IMGMESH_INLINE bool is_legal(const Place& a, const Place& b, const Place& c, double min_fatness) {
    const std::int64_t area = area2(a, b, c);
    if (area <= 0) return false;
    const std::int64_t longest = std::max(std::max(square(a, b), square(b, c)), square(c, a));
    return static_cast<double>(area) > min_fatness * static_cast<double>(longest);
}

/// Returns whether the edge from a to b, with p and q on its sides, is not locally Delaunay.
IMGMESH_INLINE bool is_odd(const Place& a, const Place& b, const Place& p, const Place& q) {
    const auto cross = [&](const Place& o) { return std::abs(static_cast<double>(area2(o, a, b))); };
    const auto dot = [&](const Place& o) {
        return static_cast<double>(std::int64_t{a.x - o.x} * (b.x - o.x) +
                                   std::int64_t{a.y - o.y} * (b.y - o.y));
    };
    return cross(p) * dot(q) + dot(p) * cross(q) < 0;
}

/// The squared error of a face is energy - 2 rhs.c + weight c.c in the colour c of its first corner.
struct CornerFit {
    Double4 energy = {};  ///< its lanes add up
    Double4 rhs = {};
    double weight = 0;

    IMGMESH_INLINE double error(const Double4& color) const {
        return sum_lanes(energy + color * (weight * color - 2 * rhs));
    }
};

/// Fits the first corner of the face (at, b, c) whose pixels have these moments.
CornerFit corner_fit(const Moments& moments, const Place& at, const Spot& b, const Spot& c);

/// The faces (point, spot[k], spot[k + 1]) for 0 <= k < faces; if closed, the last spot is the first one.
/// Point is a vertex, or a place where one could be.
struct Fan {
    std::size_t faces = 0;
    bool closed = false;
    std::array<Spot, OneRing::kMaxFaces + 1> spot;
    std::array<Moments, OneRing::kMaxFaces> link;  ///< of the edges from spot[k] to spot[k + 1]
    /// The corner of the face beyond each of these edges; spot[k] itself on the border.
    std::array<Place, OneRing::kMaxFaces> beyond;

    /// Computes `link`.
    void measure_links(const RowSums& sums);
    bool is_legal(const Place& at, double min_fatness) const;
    /// Returns how many edges of the fan's faces are not locally Delaunay.
    int odd_edges(const Place& at) const;
};

/// A fan with its point at some place, in its best colour there.
struct FanFit {
    Place place;
    Double4 color = {};
    double error = 0;  ///< of all faces
    std::array<CornerFit, OneRing::kMaxFaces> face;
};

/// Pulls a vertex of few pixels to the colour that it has, with the weight of so many pixels.
inline constexpr double kColorPull = 1e-3;

/// Fits the colour of a fan's point at a legal place.
void fit_fan(const RowSums& sums, const Fan& fan, const Place& at, const Double4& color, FanFit& out);

/// The squared error of a face is energy - 2 sum rhs[i].c[i] + sum gram[i][j] c[i].c[j], for its corners'
/// colours c.
struct FaceFit {
    double energy = 0;
    double gram[3][3] = {};  ///< sums of products of the corners' weights
    Double4 rhs[3] = {};     ///< sums of weight times image

    double error(const Double4& a, const Double4& b, const Double4& c) const;
};
FaceFit face_fit(const RowSums& sums, const Place& a, const Place& b, const Place& c);

}  // namespace imgmesh
