// Quadric error metrics over the image plane, in canonical form.
//
// A quadric measures, for a point p of the plane with features s, a sum of squared errors against many
// triangles. Written as A, b, c (paper sec. 3.2; Hoppe 1999) large terms cancel. Completed to a square
// nothing does:
//
//     Q(p, s) = (p - m_p)' S (p - m_p)  +  W |s - m_s - G (p - m_p)|^2  +  e
//
// with (m_p, m_s) the minimiser, e >= 0 the least error, W the total area, G the mean feature gradient, S 2x2
// positive definite. For colour it is 16 floats, one cache line; float instead of double costs nothing that
// can be measured.
#pragma once

#include <cmath>

namespace imgmesh {

/// T: float, or Float8 for eight quadrics side by side.
template <int C, typename T = float>
struct Quadric {
    static constexpr int kChannels = C;

    T px = {}, py = {};              ///< m_p, position of the minimiser [pixels]
    T s[C] = {};                     ///< m_s, its features
    T gx[C] = {}, gy[C] = {};        ///< G, mean gradient [feature / pixel]
    T sxx = {}, sxy = {}, syy = {};  ///< S
    T weight = {};                   ///< W
    T error = {};                    ///< e

    /// Error at position p with the best features for it.
    float at(float x, float y) const { return error + rise(x, y); }
    /// at() - error.
    float rise(float x, float y) const {
        const float dx = x - px, dy = y - py;
        return dx * (sxx * dx + sxy * dy) + dy * (sxy * dx + syy * dy);
    }
    /// Error of position p with features f.
    float at(float x, float y, const float* f) const {
        float sum = 0;
        for (int c = 0; c < C; ++c) {
            const float d = f[c] - feature(c, x, y);
            sum += d * d;
        }
        return at(x, y) + weight * sum;
    }
    /// The best y beside an imposed x, and the best x beside an imposed y.
    float best_y(float x) const { return py - sxy * (x - px) / syy; }
    float best_x(float y) const { return px - sxy * (y - py) / sxx; }
    /// Whether one position is best, whatever is fixed: always so with a positive lambda.
    static constexpr bool has_minimum(unsigned /*fixed*/) { return true; }
    /// The best feature c for position p.
    float feature(int c, float x, float y) const { return s[c] + gx[c] * (x - px) + gy[c] * (y - py); }
    /// All C of them.
    void features(float x, float y, float* out) const {
        for (int c = 0; c < C; ++c) out[c] = feature(c, x, y);
    }
};

/// Minimiser of Q_i + Q_j, relative to that of Q_i, and how much the least error grows.
template <typename T>
struct MergedMinimum {
    T qx, qy;     ///< m_p - m_p,i
    T increment;  ///< e - e_i - e_j
};

/// What the sum of two quadrics depends on beside their own members. E = G_i - G_j, r is the difference of
/// their features at j's minimiser.
template <typename T>
struct MergeTerms {
    T h;                          ///< W_i W_j / (W_i + W_j)
    T dx, dy;                     ///< m_p,j - m_p,i
    T txx, txy, tyy, ux, uy, rr;  ///< E'E, E'r, r'r
};

template <int C, typename T>
inline __attribute__((always_inline)) MergeTerms<T> merge_terms(const Quadric<C, T>& i,
                                                                const Quadric<C, T>& j) {
    MergeTerms<T> m{
        i.weight * j.weight / (i.weight + j.weight), j.px - i.px, j.py - i.py, {}, {}, {}, {}, {}, {}};
    for (int c = 0; c < C; ++c) {
        const T ex = i.gx[c] - j.gx[c], ey = i.gy[c] - j.gy[c];
        const T r = i.s[c] - j.s[c] + j.gx[c] * m.dx + j.gy[c] * m.dy;
        m.txx += ex * ex;
        m.txy += ex * ey;
        m.tyy += ey * ey;
        m.ux += ex * r;
        m.uy += ey * r;
        m.rr += r * r;
    }
    return m;
}

/// Sum of two quadrics, in closed form (derivation in docs/decisions/0001-canonical-quadric.md). Where S is
/// singular, the minimiser is not unique: the midpoint of both is taken. O(1), about 60 flops.
template <int C, typename T>
inline __attribute__((always_inline)) MergedMinimum<T> merged_minimum(const Quadric<C, T>& i,
                                                                      const Quadric<C, T>& j,
                                                                      const MergeTerms<T>& terms) {
    const auto& [h, dx, dy, txx, txy, tyy, ux, uy, rr] = terms;
    const T axx = i.sxx + j.sxx + h * txx, axy = i.sxy + j.sxy + h * txy, ayy = i.syy + j.syy + h * tyy;
    const T bx = j.sxx * dx + j.sxy * dy - h * ux, by = j.sxy * dx + j.syy * dy - h * uy;
    const T det = axx * ayy - axy * axy;
    // Below this, rounding decides the solution's direction.
    constexpr float kSingular = 1e-6f;
    // Both outcomes are computed, so that the compiler can choose between them without a branch, lane by
    // lane.
    const auto regular = det > kSingular * (axx + ayy) * (axx + ayy);
    const T inverse = 1 / det;
    const T x = (ayy * bx - axy * by) * inverse, y = (axx * by - axy * bx) * inverse;
    const T middle_x = 0.5f * dx, middle_y = 0.5f * dy;
    MergedMinimum<T> m;
    m.qx = regular ? x : middle_x;
    m.qy = regular ? y : middle_y;
    const T wx = m.qx - dx, wy = m.qy - dy;
    const T own = m.qx * (i.sxx * m.qx + i.sxy * m.qy) + m.qy * (i.sxy * m.qx + i.syy * m.qy);
    const T other = wx * (j.sxx * wx + j.sxy * wy) + wy * (j.sxy * wx + j.syy * wy);
    const T color = rr + 2 * (ux * m.qx + uy * m.qy) + m.qx * (txx * m.qx + txy * m.qy) +
                    m.qy * (txy * m.qx + tyy * m.qy);
    m.increment = own + other + h * (color > T{} ? color : T{});
    return m;
}

template <int C, typename T>
inline __attribute__((always_inline)) MergedMinimum<T> merged_minimum(const Quadric<C, T>& i,
                                                                      const Quadric<C, T>& j) {
    return merged_minimum(i, j, merge_terms(i, j));
}

/// Q_i + Q_j in canonical form.
template <int C>
Quadric<C> merged(const Quadric<C>& i, const Quadric<C>& j) {
    const MergedMinimum<float> m = merged_minimum(i, j);
    Quadric<C> sum;
    sum.weight = i.weight + j.weight;
    sum.px = i.px + m.qx;
    sum.py = i.py + m.qy;
    const float wi = i.weight / sum.weight, wj = j.weight / sum.weight, h = wi * j.weight;
    sum.sxx = i.sxx + j.sxx;
    sum.sxy = i.sxy + j.sxy;
    sum.syy = i.syy + j.syy;
    for (int c = 0; c < C; ++c) {
        const float ex = i.gx[c] - j.gx[c], ey = i.gy[c] - j.gy[c];
        sum.sxx += h * ex * ex;
        sum.sxy += h * ex * ey;
        sum.syy += h * ey * ey;
        sum.gx[c] = wi * i.gx[c] + wj * j.gx[c];
        sum.gy[c] = wi * i.gy[c] + wj * j.gy[c];
        sum.s[c] = wi * i.feature(c, sum.px, sum.py) + wj * j.feature(c, sum.px, sum.py);
    }
    sum.error = i.error + j.error + m.increment;
    return sum;
}

}  // namespace imgmesh
