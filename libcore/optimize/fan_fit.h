// The faces around one point as a function of the point's colour: a least-squares problem with one unknown.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "libcore/mesh/one_ring.h"
#include "libcore/optimize/row_sums.h"

namespace imgmesh {

IMGMESH_INLINE double sum_lanes(const Double4& v) {
    return (v[0] + v[1]) + (v[2] + v[3]);
}

/// A vertex: where it is, and its colour with up to four channels.
struct Spot {
    Place place;
    Double4 color = {};
};

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

    /// Returns the longest distance to a spot [places].
    double reach(const Place& from) const {
        double most = 0;
        for (std::size_t k = 0; k <= faces; ++k) {
            const double dx = spot[k].place.x - from.x, dy = spot[k].place.y - from.y;
            most = std::max(most, dx * dx + dy * dy);
        }
        return std::sqrt(most);
    }
    /// Computes `link`.
    void measure_links(const RowSums& sums);
};

/// A fan with its point at some place, in its best colour there.
struct FanFit {
    Place place;
    Double4 color = {};
    CornerFit total;   ///< of all faces
    double error = 0;  ///< of all faces, and the cost of their shapes
    std::array<CornerFit, OneRing::kMaxFaces> face;
    double shape_cost = 0;                              ///< the sum of `shape`
    std::array<double, OneRing::kMaxFaces> shape = {};  ///< what the shape of each face costs

    /// Sets the colour, and the error with it.
    IMGMESH_INLINE void set_color(const Double4& c) {
        color = c;
        error = total.error(c) + shape_cost;
    }
    IMGMESH_INLINE double face_cost(std::size_t k) const { return face[k].error(color) + shape[k]; }
};

/// Returns the Gauss-Newton step of a fan's point with its best colour [places].
struct FanStep {
    double x = 0, y = 0;
};
FanStep newton_step(const Fan& fan, const FanFit& fit, std::uint8_t fixed);

/// Pulls a vertex of few pixels to the colour that it has, with the weight of so many pixels.
inline constexpr double kColorPull = 1e-3;

/// Fits the colour of a fan's point at a legal place; `out` has the costs of shapes.
void fit_fan(const RowSums& sums, const Fan& fan, const Place& at, const Double4& color, FanFit& out);

/// The squared errors of the faces (p, a, q) and (q, b, p), in the colours of their corners.
struct FlipFit {
    double first = 0, second = 0;
};
FlipFit fit_flip(const RowSums& sums, const Spot& p, const Spot& a, const Spot& q, const Spot& b);

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
