// Source: docs/decisions/0002-relaxed-map.md. The paper tracks pixels through every collapse instead
// (sec. 3.3).
#include "libcore/param/relax.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

constexpr float kLongestStep = 0.5f;
constexpr int kHalvings = 2;

// Twice the area of the triangle p, q, r, positive in the orientation of (0,0), (1,0), (0,1).
float area2(const Vec2f& p, const Vec2f& q, const Vec2f& r) {
    return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
}

// The images of the eight pixels around one, in cyclic order from the east over the south.
struct Neighborhood {
    Vec2f around[8];
    bool inside[8];

    // Each quad of the grid around p keeps its three triangles at p fat enough.
    bool allows(const Vec2f& p) const {
        for (int k = 0; k < 8; k += 2) {
            const int m = (k + 2) % 8;
            if (!inside[k] || !inside[m]) continue;
            const Vec2f &a = around[k], &corner = around[k + 1], &b = around[m];
            if (area2(p, a, b) < kLeastMovingArea || area2(p, a, corner) < kLeastMovingArea ||
                area2(p, corner, b) < kLeastMovingArea)
                return false;
        }
        return true;
    }
};
constexpr int kStepX[8] = {1, 1, 0, -1, -1, -1, 0, 1};
constexpr int kStepY[8] = {0, 1, 1, 1, 0, -1, -1, -1};

Vec2f gauss_newton_step(const FaceField& field, const Vec2f& p, const float* color, const Vec2f& target,
                        float mu) {
    float jxx = mu, jxy = 0, jyy = mu;
    float bx = mu * (target.x() - p.x()), by = mu * (target.y() - p.y());
    const float dx = p.x() - field.ax, dy = p.y() - field.ay;
    for (int c = 0; c < 3; ++c) {
        const float gx = field.fx[c], gy = field.fy[c];
        const float e = field.f[c] + gx * dx + gy * dy - color[c];
        jxx += gx * gx;
        jxy += gx * gy;
        jyy += gy * gy;
        bx -= gx * e;
        by -= gy * e;
    }
    const float det = jxx * jyy - jxy * jxy;  // >= mu^2
    return {(jyy * bx - jxy * by) / det, (jxx * by - jxy * bx) / det};
}

}  // namespace

MovingPixels resting_pixels(const PixelMap& trivial) {
    MovingPixels pixels{trivial.width, trivial.height, {}, {}};
    pixels.displacement.assign(trivial.coords.size(), Vec2f::Zero());
    pixels.face.reserve(trivial.coords.size());
    for (const PixelCoord& coord : trivial.coords) pixels.face.push_back(coord.face);
    return pixels;
}

void relax(MovingPixels& pixels, const std::vector<FaceField>& fields, const std::vector<Face>& neighbors,
           const FeatureImage& feature, float smoothness, int sweeps) {
    const int w = pixels.width, h = pixels.height;

    const auto move_pixel = [&](int x, int y) {
        const std::size_t index = pixels.index(x, y);
        Neighborhood near;
        Vec2f mean = Vec2f::Zero();
        float count = 0;
        for (int k = 0; k < 8; ++k) {
            const int nx = x + kStepX[k], ny = y + kStepY[k];
            near.inside[k] = nx >= 0 && nx < w && ny >= 0 && ny < h;
            if (!near.inside[k]) continue;
            const Vec2f& d = pixels.displacement[pixels.index(nx, ny)];
            near.around[k] = Vec2f(static_cast<float>(nx), static_cast<float>(ny)) + d;
            if (k % 2 == 0) {
                mean += d;
                ++count;
            }
        }
        const Vec2f rest(static_cast<float>(x), static_cast<float>(y));
        const Vec2f p = rest + pixels.displacement[index];
        Vec2f step = gauss_newton_step(fields[pixels.face[index]], p, feature.pixel(index),
                                       rest + mean / count, smoothness);
        if (x == 0 || x == w - 1) step.x() = 0;
        if (y == 0 || y == h - 1) step.y() = 0;
        step *= std::min(1.0f, kLongestStep / std::max(step.norm(), 1e-20f));
        for (int half = 0; half <= kHalvings; ++half, step *= 0.5f) {
            const Vec2f q((p + step).cwiseMax(0.0f).cwiseMin(
                Vec2f(static_cast<float>(w - 1), static_cast<float>(h - 1))));
            if (!near.allows(q)) continue;
            pixels.displacement[index] = q - rest;
            pixels.face[index] = walk_to(q, pixels.face[index], fields, neighbors);
            return;
        }
    };

    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (int parity = 0; parity < 4; ++parity)
            // Blocks of even height keep pixels of one parity in different blocks apart.
            parallel_blocks(0, (h + 1) / 2, 16, [&](int first, int last) {
                for (int row = first; row < last; ++row) {
                    const int y = 2 * row + parity / 2;
                    if (y >= h) break;
                    for (int x = parity % 2; x < w; x += 2) move_pixel(x, y);
                }
            });
}

}  // namespace imgmesh
