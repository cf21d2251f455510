// The step of one pixel, in its clear form.
#include <algorithm>
#include <cmath>
#include <limits>

#include "libcore/param/relax_sweep.h"

namespace imgmesh {
namespace {

// The neighbours of a pixel: their displacements, their places, and the mean displacement of the straight
// ones. Pixels that do not exist, or are outside, are NaN, which is never the lesser.
struct Around {
    float dx[8], dy[8], x[8], y[8], mean_x = 0, mean_y = 0;

    Around(const PixelEmbedding& pixels, int px, int py) {
        float count = 0;
        for (int k = 0; k < 8; ++k) {
            const int i = px + kStepX[k], j = py + kStepY[k];
            const bool inside = pixels.contains(i, j);
            dx[k] = inside ? pixels.dx[pixels.index(i, j)] : std::numeric_limits<float>::quiet_NaN();
            dy[k] = inside ? pixels.dy[pixels.index(i, j)] : std::numeric_limits<float>::quiet_NaN();
            x[k] = static_cast<float>(i) + dx[k];
            y[k] = static_cast<float>(j) + dy[k];
            if (k % 2 != 0 || std::isnan(dx[k])) continue;
            mean_x += dx[k];
            mean_y += dy[k];
            ++count;
        }
        mean_x /= count;
        mean_y /= count;
    }
};

// Whether a place is on the far side of one of the face's edges.
bool beyond(const FaceField& field, float x, float y) {
    const float u = field.u(x, y), v = field.v(x, y);
    return lesser(lesser(u, v), 1 - u - v) < 0;
}

}  // namespace

void RelaxSweep::move_pixel(int x, int y) const {
    const std::size_t index = pixels.index(x, y);
    if (pixels.outside(index) || pixels.stays(x, y)) return;
    const Around around(pixels, x, y);
    const float rest_x = static_cast<float>(x), rest_y = static_cast<float>(y);
    const float own_x = pixels.dx[index], own_y = pixels.dy[index];
    const float px = rest_x + own_x, py = rest_y + own_y;
    float sx, sy;
    const FaceField& field = fields[pixels.face[index]];
    const float* color = feature.pixel(index);
    NewtonStep<float> step(px, py, rest_x + around.mean_x, rest_y + around.mean_y, mu);
    const float from_ax = px - field.ax, from_ay = py - field.ay;
    step.add_features(field.f, field.fx, field.fy, color, std::min(3, feature.channels), from_ax, from_ay);
    const float* f = auxiliary.of(pixels.face[index]);
    for (std::size_t c = 0; c < auxiliary.features; ++c, f += 3)
        step.add_features(f, f + 1, f + 2, color + 3 + c, 1, from_ax, from_ay);
    step.solve(stride, sx, sy);
    if (rate > 0 && pixels.is_free(x, y)) make_cheap(step, own_x, own_y, around.dx, around.dy, sx, sy);
    const bool pinned_x = pixels.pinned_x(x, y), pinned_y = pixels.pinned_y(x, y);
    if (pinned_x) sx = 0;
    if (pinned_y) sy = 0;
    const float least_here = least_in(field.longest);
    for (int tries = 0; tries <= kTurns + kHalvings; ++tries) {
        const float qx = on_image(rest_x + on_grid(own_x + sx), pixels.width);
        const float qy = on_image(rest_y + on_grid(own_y + sy), pixels.height);
        if (least_area(qx, qy, around.x, around.y) >= least_here) {
            if (beyond(field, qx, qy))
                cross(x, y, qx, qy);
            else if (is_better(step, qx - px, qy - py))
                place(index, qx - rest_x, qy - rest_y, pixels.face[index]);
            return;
        }
        float to_x = px + sx, to_y = py + sy;
        widen_least(to_x, to_y, around.x, around.y, least_here + kSpareArea);
        const bool turn = tries < kTurns;
        sx = pinned_x ? 0 : turn ? to_x - px : sx * 0.5f;
        sy = pinned_y ? 0 : turn ? to_y - py : sy * 0.5f;
    }
}

void RelaxSweep::cross(int x, int y, float qx, float qy) const {
    const std::size_t index = pixels.index(x, y);
    const Around around(pixels, x, y);
    const float rest_x = static_cast<float>(x), rest_y = static_cast<float>(y);
    const float own_x = pixels.dx[index], own_y = pixels.dy[index];
    const Id own = pixels.face[index];
    const float now =
        energy(index, own, rest_x + own_x, rest_y + own_y, rest_x + around.mean_x, rest_y + around.mean_y);
    for (const bool half : {false, true}) {
        if (half) {
            qx = on_image(rest_x + on_grid(own_x + (qx - rest_x - own_x) * 0.5f), pixels.width);
            qy = on_image(rest_y + on_grid(own_y + (qy - rest_y - own_y) * 0.5f), pixels.height);
            if (!(least_area(qx, qy, around.x, around.y) >= least_in(fields[own].longest))) return;
        }
        const Id face = locate_face({qx, qy}, own, fields, neighbors);
        if (rate <= 0 && !(energy(index, face, qx, qy, rest_x + around.mean_x, rest_y + around.mean_y) < now))
            continue;
        if (may_lie_in(face, {qx, qy})) place(index, qx - rest_x, qy - rest_y, face);
        return;
    }
}

// What it costs a pixel to be at a place of a face, if its neighbours would have it at (tx, ty).
float RelaxSweep::energy(std::size_t index, Id face, float px, float py, float tx, float ty) const {
    const FaceField& field = fields[face];
    const float* color = feature.pixel(index);
    const float dx = px - field.ax, dy = py - field.ay;
    float sum = mu * ((px - tx) * (px - tx) + (py - ty) * (py - ty));
    const auto add = [&](float f, float fx, float fy, float wanted) {
        const float e = f + fx * dx + fy * dy - wanted;
        sum += e * e;
    };
    for (int c = 0; c < std::min(3, feature.channels); ++c)
        add(field.f[c], field.fx[c], field.fy[c], color[c]);
    const float* f = auxiliary.of(face);
    for (std::size_t c = 0; c < auxiliary.features; ++c, f += 3) add(f[0], f[1], f[2], color[3 + c]);
    return sum;
}

// Whether locating p ended there and not at a boundary in between. A rectangle has none between.
bool RelaxSweep::may_lie_in(Id face, const Vec2f& p) const {
    if (pixels.freedom.empty()) return true;
    const Vec2f &a = mesh.position[mesh.faces[face][0]], &b = mesh.position[mesh.faces[face][1]],
                &c = mesh.position[mesh.faces[face][2]];
    return std::min({signed_area2(a, b, p), signed_area2(b, c, p), signed_area2(c, a, p)}) >= 0;
}

}  // namespace imgmesh
