// Eight quadrics of colours side by side: between records in memory and one vector for each member.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "libcore/base/simd.h"
#include "libcore/base/transpose.h"
#include "libcore/base/types.h"
#include "libcore/simplify/quadrics/quadric.h"

namespace imgmesh {

using ColorQuadric = Quadric<3>;
using ColorQuadric8 = Quadric<3, Float8>;

// A record is copied as two vectors of bytes, which hold its members in this order.
static_assert(std::is_trivially_copyable_v<ColorQuadric> && sizeof(ColorQuadric) == 2 * sizeof(Float8));
static_assert(offsetof(ColorQuadric, s) == 2 * sizeof(float) &&
              offsetof(ColorQuadric, gx) == 5 * sizeof(float) &&
              offsetof(ColorQuadric, gy) == 8 * sizeof(float) &&
              offsetof(ColorQuadric, sxx) == 11 * sizeof(float) &&
              offsetof(ColorQuadric, weight) == 14 * sizeof(float));

IMGMESH_INLINE void store4(float* p, const Float4& v) {
    std::memcpy(p, &v, sizeof v);
}

/// Half a record: 0 or 1.
IMGMESH_INLINE Float8 half_of(const ColorQuadric& quadric, std::size_t half) {
    Float8 v;
    std::memcpy(&v, reinterpret_cast<const std::byte*>(&quadric) + half * sizeof v, sizeof v);
    return v;
}

/// One vector for each member of eight quadrics, in the order of the members of a record.
inline constexpr int kQuadricMembers = sizeof(ColorQuadric) / sizeof(float);
using QuadricMembers = Float8[kQuadricMembers];

IMGMESH_INLINE ColorQuadric8 quadric_of(const QuadricMembers& member) {
    ColorQuadric8 q;
    q.px = member[0];
    q.py = member[1];
    for (int c = 0; c < 3; ++c) {
        q.s[c] = member[2 + c];
        q.gx[c] = member[5 + c];
        q.gy[c] = member[8 + c];
    }
    q.sxx = member[11];
    q.sxy = member[12];
    q.syy = member[13];
    q.weight = member[14];
    q.error = member[15];
    return q;
}

/// Reads the quadrics of these eight numbers, one into each lane.
template <class Number>
IMGMESH_INLINE void read_members(const ColorQuadric* quadrics, const Number* which, QuadricMembers& member) {
    Float8 low[8], high[8];
    for (int lane = 0; lane < 8; ++lane) {
        low[lane] = half_of(quadrics[which[lane]], 0);
        high[lane] = half_of(quadrics[which[lane]], 1);
    }
    transpose8(low);
    transpose8(high);
    for (int m = 0; m < 8; ++m) {
        member[m] = low[m];
        member[8 + m] = high[m];
    }
}

/// The quadrics of these eight numbers, one in each lane.
template <class Number>
IMGMESH_INLINE ColorQuadric8 side_by_side(const ColorQuadric* quadrics, const Number* which) {
    QuadricMembers member;
    read_members(quadrics, which, member);
    return quadric_of(member);
}

/// The way back, to eight quadrics that follow each other.
IMGMESH_INLINE void write_in_turn(const ColorQuadric8& q, ColorQuadric* out) {
    Float8 low[8] = {q.px, q.py, q.s[0], q.s[1], q.s[2], q.gx[0], q.gx[1], q.gx[2]};
    Float8 high[8] = {q.gy[0], q.gy[1], q.gy[2], q.sxx, q.sxy, q.syy, q.weight, q.error};
    transpose8(low);
    transpose8(high);
    for (int lane = 0; lane < 8; ++lane) {
        auto* bytes = reinterpret_cast<std::byte*>(out + lane);
        std::memcpy(bytes, &low[lane], sizeof low[lane]);
        std::memcpy(bytes + sizeof low[lane], &high[lane], sizeof high[lane]);
    }
}

/// The same quadric in every lane.
IMGMESH_INLINE ColorQuadric8 in_every_lane(const ColorQuadric& quadric) {
    const Float8 zero = {};
    ColorQuadric8 q;
    q.px = zero + quadric.px;
    q.py = zero + quadric.py;
    for (int c = 0; c < 3; ++c) {
        q.s[c] = zero + quadric.s[c];
        q.gx[c] = zero + quadric.gx[c];
        q.gy[c] = zero + quadric.gy[c];
    }
    q.sxx = zero + quadric.sxx;
    q.sxy = zero + quadric.sxy;
    q.syy = zero + quadric.syy;
    q.weight = zero + quadric.weight;
    q.error = zero + quadric.error;
    return q;
}

/// merged(), to the bit, with the channels side by side.
IMGMESH_INLINE void merge_colors(const ColorQuadric& i, const ColorQuadric& j, ColorQuadric& sum) {
    // Three channels and the member behind them, whose results are not used.
    const Float4 gx_i = load4(i.gx), gx_j = load4(j.gx), gy_i = load4(i.gy), gy_j = load4(j.gy);
    const Float4 ex = gx_i - gx_j, ey = gy_i - gy_j;
    MergeTerms<float> t;
    t.h = i.weight * j.weight / (i.weight + j.weight);
    t.dx = j.px - i.px;
    t.dy = j.py - i.py;
    const Float4 r = load4(i.s) - load4(j.s) + gx_j * t.dx + gy_j * t.dy;
    // Sums over the three channels: transposed, so that a lane is a sum.
    const Float4 a = ex * ex, b = ex * ey, c = ey * ey, d = ex * r, e = ey * r, f = r * r;
    const Float4 ab = __builtin_shufflevector(a, b, 0, 4, 1, 5),
                 cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
    const Float4 first = __builtin_shufflevector(ab, cd, 0, 1, 4, 5),
                 second = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
    const Float4 ab_third = __builtin_shufflevector(a, b, 2, 6, 2, 6),
                 third =
                     __builtin_shufflevector(ab_third, __builtin_shufflevector(c, d, 2, 6, 2, 6), 0, 1, 4, 5);
    const Float4 sums = first + second + third;
    t.txx = sums[0];
    t.txy = sums[1];
    t.tyy = sums[2];
    t.ux = sums[3];
    t.uy = e[0] + e[1] + e[2];
    t.rr = f[0] + f[1] + f[2];
    const MergedMinimum<float> m = merged_minimum(i, j, t);
    const float weight = i.weight + j.weight, px = i.px + m.qx, py = i.py + m.qy;
    const float wi = i.weight / weight, wj = j.weight / weight;
    const Float4 s = wi * (load4(i.s) + gx_i * (px - i.px) + gy_i * (py - i.py)) +
                     wj * (load4(j.s) + gx_j * (px - j.px) + gy_j * (py - j.py));
    // In the order of members, so that the next one writes what lies behind the channels.
    sum.px = px;
    sum.py = py;
    store4(sum.s, s);
    store4(sum.gx, wi * gx_i + wj * gx_j);
    store4(sum.gy, wi * gy_i + wj * gy_j);
    // S and the member behind it, channel by channel.
    const Float4 hx = wi * j.weight * ex, hy = wi * j.weight * ey;
    const Float4 xx = hx * ex, xy = hx * ey, yy = hy * ey;
    const Float4 xx_xy = __builtin_shufflevector(xx, xy, 0, 4, 1, 5);
    Float4 spread = load4(&i.sxx) + load4(&j.sxx);
    spread += __builtin_shufflevector(xx_xy, yy, 0, 1, 4, 4);
    spread += __builtin_shufflevector(xx_xy, yy, 2, 3, 5, 5);
    spread += __builtin_shufflevector(__builtin_shufflevector(xx, xy, 2, 6, 2, 6), yy, 0, 1, 6, 6);
    store4(&sum.sxx, spread);
    sum.weight = weight;
    sum.error = i.error + j.error + m.increment;
}

}  // namespace imgmesh
