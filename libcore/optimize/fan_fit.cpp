#include "libcore/optimize/fan_fit.h"

#include <algorithm>

#include "libcore/mesh/fixed_axes.h"
#include "libcore/optimize/edge_sums.h"

namespace imgmesh {
namespace {

using edge_sums::edge_of;

constexpr double kPixels = 1.0 / kPlacesPerPixel;

// Moments in coordinates relative to a point [pixels]: exact, as positions are multiples of 1/32.
struct LocalMoments {
    double n, x, y, xx, xy, yy, energy;
    Double4 i, xi, yi;

    IMGMESH_INLINE LocalMoments(const Moments& m, const Place& origin) {
        const double ox = kPixels * origin.x, oy = kPixels * origin.y;
        n = m.shape[0];
        const double sx = m.shape[1], sy = m.rows[0];
        x = sx - ox * n;
        y = sy - oy * n;
        xx = m.shape[2] - ox * (sx + x);
        xy = m.rows[1] - ox * sy - oy * x;
        yy = m.rows[2] - oy * (sy + y);
        energy = m.shape[3];
        i = m.i;
        xi = m.xi - ox * m.i;
        yi = m.yi - oy * m.i;
    }
};

// Weights of the second corner, bx x + by y, and of the third one, cx x + cy y, in coordinates relative to
// the first one.
struct CornerWeights {
    double bx, by, cx, cy;

    IMGMESH_INLINE CornerWeights(const Place& a, const Place& b, const Place& c) {
        const double px = kPixels * (b.x - a.x), py = kPixels * (b.y - a.y);
        const double qx = kPixels * (c.x - a.x), qy = kPixels * (c.y - a.y);
        const double inverse = 1 / (px * qy - py * qx);
        bx = qy * inverse;
        by = -qx * inverse;
        cx = -py * inverse;
        cy = px * inverse;
    }
};

IMGMESH_INLINE CornerFit corner_fit_of(const Moments& moments, const Place& at, const Spot& b,
                                       const Spot& c) {
    const LocalMoments m(moments, at);
    const CornerWeights w(at, b.place, c.place);
    // The first corner's weight is 1 + ax x + ay y, the colour of the others gx x + gy y.
    const double ax = -w.bx - w.cx, ay = -w.by - w.cy;
    const Double4 gx = w.bx * b.color + w.cx * c.color, gy = w.by * b.color + w.cy * c.color;
    const double wx = m.x + ax * m.xx + ay * m.xy, wy = m.y + ax * m.xy + ay * m.yy;
    CornerFit fit;
    fit.weight = m.n + ax * (m.x + wx) + ay * (m.y + wy);
    fit.rhs = m.i + ax * m.xi + ay * m.yi - gx * wx - gy * wy;
    fit.energy = gx * (m.xx * gx + (2 * m.xy) * gy - 2 * m.xi) + gy * (m.yy * gy - 2 * m.yi);
    fit.energy[3] += m.energy;
    return fit;
}

IMGMESH_INLINE void fit_fan_of(const RowView& sums, const Fan& fan, const Place& at, const Double4& color,
                               FanFit& out) {
    out.place = at;
    CornerFit& total = out.total;
    total.energy = Double4{};
    total.weight = kColorPull;
    total.rhs = kColorPull * color;
    Moments first, before, after;
    edge_of(sums, at, fan.spot[0].place, first);
    before = first;
    for (std::size_t k = 0; k < fan.faces; ++k) {
        if (fan.closed && k + 1 == fan.faces)
            after = first;
        else
            edge_of(sums, at, fan.spot[k + 1].place, after);
        Moments face = fan.link[k];
        add(face, before);
        subtract(face, after);
        CornerFit& fit = out.face[k];
        fit = corner_fit_of(face, at, fan.spot[k], fan.spot[k + 1]);
        total.energy += fit.energy;
        total.rhs += fit.rhs;
        total.weight += fit.weight;
        before = after;
    }
    const Double4 best = total.rhs / total.weight;
    total.weight -= kColorPull;
    total.rhs -= kColorPull * color;
    out.set_color(best);
}

IMGMESH_INLINE FlipFit fit_flip_of(const RowView& sums, const Spot& p, const Spot& a, const Spot& q,
                                   const Spot& b) {
    Moments first, second, edge;
    edge_of(sums, p.place, a.place, first);
    edge_of(sums, a.place, q.place, edge);
    add(first, edge);
    edge_of(sums, q.place, b.place, second);
    edge_of(sums, b.place, p.place, edge);
    add(second, edge);
    edge_of(sums, q.place, p.place, edge);
    add(first, edge);
    subtract(second, edge);
    return {corner_fit_of(first, p.place, a, q).error(p.color),
            corner_fit_of(second, q.place, b, p).error(q.color)};
}

IMGMESH_INLINE FaceFit face_fit_of(const RowView& sums, const Place& a, const Place& b, const Place& c) {
    Moments total, edge;
    edge_of(sums, a, b, total);
    edge_of(sums, b, c, edge);
    add(total, edge);
    edge_of(sums, c, a, edge);
    add(total, edge);
    const LocalMoments m(total, a);
    const CornerWeights w(a, b, c);
    FaceFit fit;
    fit.energy = m.energy;
    const double wb = w.bx * m.x + w.by * m.y, wc = w.cx * m.x + w.cy * m.y;
    const double bb = w.bx * (w.bx * m.xx + 2 * w.by * m.xy) + w.by * w.by * m.yy;
    const double cc = w.cx * (w.cx * m.xx + 2 * w.cy * m.xy) + w.cy * w.cy * m.yy;
    const double bc = w.bx * (w.cx * m.xx + w.cy * m.xy) + w.by * (w.cx * m.xy + w.cy * m.yy);
    const double ab = wb - bb - bc, ac = wc - bc - cc, aa = m.n - wb - wc - ab - ac;
    const double gram[3][3] = {{aa, ab, ac}, {ab, bb, bc}, {ac, bc, cc}};
    std::copy(&gram[0][0], &gram[0][0] + 9, &fit.gram[0][0]);
    fit.rhs[1] = w.bx * m.xi + w.by * m.yi;
    fit.rhs[2] = w.cx * m.xi + w.cy * m.yi;
    fit.rhs[0] = m.i - fit.rhs[1] - fit.rhs[2];
    return fit;
}

#if defined(__x86_64__)
#define IMGMESH_AVX2 __attribute__((target("avx2")))
// One copy of an edge for all of them.
IMGMESH_AVX2 void fit_fan_avx2(const RowView& sums, const Fan& fan, const Place& at, const Double4& color,
                               FanFit& out) {
    fit_fan_of(sums, fan, at, color, out);
}
IMGMESH_AVX2 FlipFit fit_flip_avx2(const RowView& sums, const Spot& p, const Spot& a, const Spot& q,
                                   const Spot& b) {
    return fit_flip_of(sums, p, a, q, b);
}
IMGMESH_AVX2 FaceFit face_fit_avx2(const RowView& sums, const Place& a, const Place& b, const Place& c) {
    return face_fit_of(sums, a, b, c);
}
IMGMESH_AVX2 CornerFit corner_fit_avx2(const Moments& moments, const Place& at, const Spot& b,
                                       const Spot& c) {
    return corner_fit_of(moments, at, b, c);
}
#undef IMGMESH_AVX2
const bool kAvx2 = has_avx2();
#endif

}  // namespace

CornerFit corner_fit(const Moments& moments, const Place& at, const Spot& b, const Spot& c) {
#if defined(__x86_64__)
    if (kAvx2) return corner_fit_avx2(moments, at, b, c);
#endif
    return corner_fit_of(moments, at, b, c);
}

void Fan::measure_links(const RowSums& sums) {
    for (std::size_t k = 0; k < faces; ++k) sums.edge(spot[k].place, spot[k + 1].place, link[k]);
}

void fit_fan(const RowSums& sums, const Fan& fan, const Place& at, const Double4& color, FanFit& out) {
#if defined(__x86_64__)
    if (kAvx2) return fit_fan_avx2(sums.view(), fan, at, color, out);
#endif
    fit_fan_of(sums.view(), fan, at, color, out);
}

FlipFit fit_flip(const RowSums& sums, const Spot& p, const Spot& a, const Spot& q, const Spot& b) {
#if defined(__x86_64__)
    if (kAvx2) return fit_flip_avx2(sums.view(), p, a, q, b);
#endif
    return fit_flip_of(sums.view(), p, a, q, b);
}

FaceFit face_fit(const RowSums& sums, const Place& a, const Place& b, const Place& c) {
#if defined(__x86_64__)
    if (kAvx2) return face_fit_avx2(sums.view(), a, b, c);
#endif
    return face_fit_of(sums.view(), a, b, c);
}

// With w the point's weight and G the gradient of a face's colour, a move of the point by d and of its colour
// by s changes a pixel by w (s - G d). Least squares over s leaves
//   (sum ww G'G - M'M / ww) d = sum G'we - M'we / ww,   M = sum ww G.
FanStep newton_step(const Fan& fan, const FanFit& fit, std::uint8_t fixed) {
    double hxx = 0, hxy = 0, hyy = 0, ww = kColorPull, rx = 0, ry = 0;
    Double4 mx = {}, my = {}, we = {};
    for (std::size_t k = 0; k < fan.faces; ++k) {
        const Spot &b = fan.spot[k], &c = fan.spot[k + 1];
        const CornerWeights w(fit.place, b.place, c.place);
        const Double4 db = b.color - fit.color, dc = c.color - fit.color;
        const Double4 gx = w.bx * db + w.cx * dc, gy = w.by * db + w.cy * dc;
        const double weight = fit.face[k].weight;
        const Double4 e = weight * fit.color - fit.face[k].rhs;
        hxx += weight * sum_lanes(gx * gx);
        hxy += weight * sum_lanes(gx * gy);
        hyy += weight * sum_lanes(gy * gy);
        rx += sum_lanes(gx * e);
        ry += sum_lanes(gy * e);
        mx += weight * gx;
        my += weight * gy;
        we += e;
        ww += weight;
    }
    hxx -= sum_lanes(mx * mx) / ww;
    hxy -= sum_lanes(mx * my) / ww;
    hyy -= sum_lanes(my * my) / ww;
    rx -= sum_lanes(mx * we) / ww;
    ry -= sum_lanes(my * we) / ww;
    const double pull = 1e-3 * (hxx + hyy) + 1e-6;
    hxx += pull;
    hyy += pull;
    if (fixed & kFixedX) return {0, kPlacesPerPixel * ry / hyy};
    if (fixed & kFixedY) return {kPlacesPerPixel * rx / hxx, 0};
    const double det = hxx * hyy - hxy * hxy;
    if (!(det > 0)) return {};
    return {kPlacesPerPixel * (hyy * rx - hxy * ry) / det, kPlacesPerPixel * (hxx * ry - hxy * rx) / det};
}

double FaceFit::error(const Double4& a, const Double4& b, const Double4& c) const {
    const Double4 lanes = a * (gram[0][0] * a + 2 * (gram[0][1] * b + gram[0][2] * c - rhs[0])) +
                          b * (gram[1][1] * b + 2 * (gram[1][2] * c - rhs[1])) +
                          c * (gram[2][2] * c - 2 * rhs[2]);
    return energy + sum_lanes(lanes);
}

}  // namespace imgmesh
