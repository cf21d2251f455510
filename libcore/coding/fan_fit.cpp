#include "libcore/coding/fan_fit.h"

#include <algorithm>

namespace imgmesh {
namespace {

constexpr double kPixels = 1.0 / kQuarters;

// Moments in coordinates relative to a point [pixels]: exact, as positions are quarters.
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

}  // namespace

CornerFit corner_fit(const Moments& moments, const Place& at, const Spot& b, const Spot& c) {
    return corner_fit_of(moments, at, b, c);
}

void Fan::measure_links(const RowSums& sums) {
    for (std::size_t k = 0; k < faces; ++k) sums.edge(spot[k].place, spot[k + 1].place, link[k]);
}

bool Fan::is_legal(const Place& at) const {
    for (std::size_t k = 0; k < faces; ++k)
        if (area2(at, spot[k].place, spot[k + 1].place) <= 0) return false;
    return true;
}

void fit_fan(const RowSums& sums, const Fan& fan, const Place& at, const Double4& color, FanFit& out) {
    out.place = at;
    CornerFit total;
    total.weight = kColorPull;
    total.rhs = kColorPull * color;
    Moments first, before, after;
    sums.edge(at, fan.spot[0].place, first);
    before = first;
    for (std::size_t k = 0; k < fan.faces; ++k) {
        if (fan.closed && k + 1 == fan.faces)
            after = first;
        else
            sums.edge(at, fan.spot[k + 1].place, after);
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
    out.color = total.rhs / total.weight;
    total.weight -= kColorPull;
    total.rhs -= kColorPull * color;
    out.error = total.error(out.color);
}

double FaceFit::error(const Double4& a, const Double4& b, const Double4& c) const {
    const Double4 lanes = a * (gram[0][0] * a + 2 * (gram[0][1] * b + gram[0][2] * c - rhs[0])) +
                          b * (gram[1][1] * b + 2 * (gram[1][2] * c - rhs[1])) +
                          c * (gram[2][2] * c - 2 * rhs[2]);
    return energy + sum_lanes(lanes);
}

FaceFit face_fit(const RowSums& sums, const Place& a, const Place& b, const Place& c) {
    Moments total, edge;
    sums.edge(a, b, total);
    sums.edge(b, c, edge);
    add(total, edge);
    sums.edge(c, a, edge);
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

}  // namespace imgmesh
