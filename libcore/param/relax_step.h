// Where a pixel of the relaxed map wants to go: formulas for one pixel (T = float) or for several side by
// side (T = Float8 or Float16). Internal to relax().
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "libcore/base/simd.h"

namespace imgmesh {

// A step assumes that the mesh's colour is linear, which holds only inside one face, so a step is at most one
// pixel.
inline constexpr float kLongestStep = 1;

/// Twice the area of the triangle p, a, b, positive in the grid's own orientation.
template <typename T>
IMGMESH_INLINE T area2(T px, T py, T ax, T ay, T bx, T by) {
    return (ax - px) * (by - py) - (ay - py) * (bx - px);
}

/// The lesser of two; `a` if b is NaN.
template <typename T>
IMGMESH_INLINE T lesser(T a, T b) {
    return b < a ? b : a;
}
template <typename T>
IMGMESH_INLINE T greater(T a, T b) {
    return b > a ? b : a;
}
/// `low` if x is NaN.
template <typename T>
IMGMESH_INLINE T clamped(T x, float low, float high) {
    const T floor = T{} + low, ceiling = T{} + high;
    x = x > floor ? x : floor;
    return x < ceiling ? x : ceiling;
}
template <typename T>
IMGMESH_INLINE T magnitude(T x) {
    return x < T{} ? -x : x;
}
/// The nearest whole number, the even one of two; |x| < 2^22. (The sum has no bits for a fraction.)
template <typename T>
IMGMESH_INLINE T rounded(T x) {
    constexpr float kNoFraction = 12582912.0f;  // 1.5 * 2^23
    return (x + kNoFraction) - kNoFraction;
}

/// The logarithm to the base 2, at most .09 too small; x >= 1. (The exponent, and the mantissa as it is.)
IMGMESH_INLINE float coarse_log2(float x) {
    std::int32_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return static_cast<float>(bits - 0x3f800000) * (1.0f / (1 << 23));
}
template <typename T>
IMGMESH_INLINE T coarse_log2(T x) {
    LaneMask<T> bits;
    std::memcpy(&bits, &x, sizeof bits);
    return __builtin_convertvector(bits - 0x3f800000, T) * (1.0f / (1 << 23));
}

/// The Gauss-Newton step at (px, py): it makes the face's features there the pixel's, and pulls towards (tx,
/// ty).
template <typename T>
struct NewtonStep {
    float mu;
    T gxx = {}, gxy = {}, gyy = {}, bx, by;

    IMGMESH_INLINE NewtonStep(T px, T py, T tx, T ty, float smoothness)
        : mu(smoothness), bx(mu * (tx - px)), by(mu * (ty - py)) {}

    // Adds a feature with gradient (gx, gy) of which the face has e too much.
    IMGMESH_INLINE void add(T gx, T gy, T e) {
        gxx += gx * gx;
        gxy += gx * gy;
        gyy += gy * gy;
        bx -= gx * e;
        by -= gy * e;
    }
    // Adds the first features: f, fx and fy are those of a FaceField, (dx, dy) counts from its corner a.
    IMGMESH_INLINE void add_features(const T* f, const T* fx, const T* fy, const T* color, int features, T dx,
                                     T dy) {
        for (int c = 0; c < features; ++c) add(fx[c], fy[c], f[c] + fx[c] * dx + fy[c] * dy - color[c]);
    }
    // Sets the step to `stride` times the way to the best place.
    IMGMESH_INLINE void solve(float stride, T& sx, T& sy) const {
        // Sums of terms that are never negative. (In J'J + mu I as one matrix, with J'J steep and singular,
        // only rounding would be left.)
        T minor = gxx * gyy - gxy * gxy;
        minor = minor > T{} ? minor : T{};
        const T inverse = stride / (mu * (mu + gxx + gyy) + minor);
        sx = clamped(((gyy + mu) * bx - gxy * by) * inverse, -kLongestStep, kLongestStep);
        sy = clamped(((gxx + mu) * by - gxy * bx) * inverse, -kLongestStep, kLongestStep);
    }
    // By how much a step changes the energy while the features stay linear.
    IMGMESH_INLINE T change(T sx, T sy) const {
        return (gxx + mu) * sx * sx + 2 * gxy * sx * sy + (gyy + mu) * sy * sy - 2 * (bx * sx + by * sy);
    }
    // How much more it costs to be (ex, ey) away from the best place.
    IMGMESH_INLINE T excess(T ex, T ey) const {
        return (gxx + mu) * ex * ex + 2 * gxy * ex * ey + (gyy + mu) * ey * ey;
    }
};

// The twelve triangles at a pixel with other corners among the eight neighbours, which go from the east over
// the south: two in a row, or two straight ones in a row.
inline constexpr int kTriangles = 12;
constexpr int first_corner(int triangle) {
    return triangle < 8 ? triangle : 2 * (triangle - 8);
}
constexpr int second_corner(int triangle) {
    return (first_corner(triangle) + (triangle < 8 ? 1 : 2)) % 8;
}

/// Returns the least of the twelve triangles at (x, y).
template <typename T>
IMGMESH_INLINE T least_area(T x, T y, const T* nx, const T* ny) {
    T least = T{} + std::numeric_limits<float>::max();
    for (int k = 0; k < kTriangles; ++k) {
        const int a = first_corner(k), b = second_corner(k);
        least = lesser(least, area2(x, y, nx[a], ny[a], nx[b], ny[b]));
    }
    return least;
}

/// Moves (x, y) by the shortest way that gives the least of the twelve triangles twice the area `wanted`,
/// unless it has that already.
template <typename T>
IMGMESH_INLINE void widen_least(T& x, T& y, const T* nx, const T* ny, T wanted) {
    T least = T{} + std::numeric_limits<float>::max(), gx{}, gy{};  // and its gradient
    for (int k = 0; k < kTriangles; ++k) {
        const int a = first_corner(k), b = second_corner(k);
        const T area = area2(x, y, nx[a], ny[a], nx[b], ny[b]);
        const auto less = area < least;
        gx = less ? ny[a] - ny[b] : gx;
        gy = less ? nx[b] - nx[a] : gy;
        least = less ? area : least;
    }
    const T way = greater(wanted - least, T{}) / (gx * gx + gy * gy);
    x += way * gx;
    y += way * gy;
}

/// The median predictor of a displacement from those of the west, the north and the northwest (Weinberger et
/// al., "The LOCO-I lossless image compression algorithm", 2000).
template <typename T>
IMGMESH_INLINE T predicted(T west, T north, T northwest) {
    return greater(lesser(west, north), lesser(greater(west, north), west + north - northwest));
}

/// Displacements [steps] around a pixel, from the east over the south. Neighbours that do not exist count as
/// the pixel's own.
template <typename T>
struct AroundPixel {
    T own, at[8];

    IMGMESH_INLINE AroundPixel(T displacement, const T* neighbors, float steps) : own(displacement * steps) {
        for (int k = 0; k < 8; ++k) at[k] = neighbors[k] == neighbors[k] ? neighbors[k] * steps : own;
    }
    IMGMESH_INLINE T prediction() const { return predicted(at[4], at[6], at[5]); }
    IMGMESH_INLINE T mean() const { return rounded((at[0] + at[2] + at[4] + at[6]) * 0.25f); }
    // The product of 1 + |residual| over the pixel and the three whose predictions depend on it.
    IMGMESH_INLINE T residuals(T d) const {
        return (1 + magnitude(d - prediction())) * (1 + magnitude(at[0] - predicted(d, at[7], at[6]))) *
               (1 + magnitude(at[2] - predicted(at[3], d, at[4]))) *
               (1 + magnitude(at[1] - predicted(at[2], at[0], d)));
    }
};

/// Replaces the best place (x, y) of a pixel, as displacements [steps], by the cheapest of eight places on
/// the grid: the best one, where the pixel is, the prediction, the neighbours' mean, and mixtures of them. A
/// place costs what the step says, and `rate` for each bit of the residuals there: log2(1 + |r|).
template <typename T>
IMGMESH_INLINE void take_cheapest(const NewtonStep<T>& step, const AroundPixel<T>& dx,
                                  const AroundPixel<T>& dy, float steps, float rate, T& x, T& y) {
    constexpr int kPlaces = 8;
    const T best_x = rounded(x), best_y = rounded(y), predicted_x = dx.prediction(),
            predicted_y = dy.prediction(), mean_x = dx.mean(), mean_y = dy.mean();
    const T xs[kPlaces] = {best_x, predicted_x, mean_x, dx.own, best_x, predicted_x, best_x, mean_x};
    const T ys[kPlaces] = {best_y, predicted_y, mean_y, dy.own, predicted_y, best_y, mean_y, best_y};
    T least = T{} + std::numeric_limits<float>::max(), to_x = best_x, to_y = best_y;
    for (int k = 0; k < kPlaces; ++k) {
        const T ex = (xs[k] - x) / steps, ey = (ys[k] - y) / steps;
        const T cost = step.excess(ex, ey) + rate * coarse_log2(dx.residuals(xs[k]) * dy.residuals(ys[k]));
        const auto better = (cost < least) & (magnitude(ex) <= T{} + 2 * kLongestStep) &
                            (magnitude(ey) <= T{} + 2 * kLongestStep);
        least = better ? cost : least;
        to_x = better ? xs[k] : to_x;
        to_y = better ? ys[k] : to_y;
    }
    x = to_x;
    y = to_y;
}

}  // namespace imgmesh
