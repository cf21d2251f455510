#include "libcore/collapse/vertex_quadrics.h"

#include <algorithm>

#include "libcore/base/parallel.h"
#include "libcore/collapse/ring_mesh.h"

namespace imgmesh {
namespace {

// With a the area of face f, t its centroid less the vertex, g its gradient, summed over the faces around the
// vertex:
//   W = sum a,  G = sum a g / W,  S = lambda W I + sum a g'g - W G'G,  q = S^-1 lambda sum a t,
//   e = lambda sum a |t|^2 - q' lambda sum a t.
template <int C>
struct Accumulator {
    float area = 0, tx = 0, ty = 0, tt = 0;
    float gx[C] = {}, gy[C] = {};
    float gxx = 0, gxy = 0, gyy = 0;

    // A face: corners at 0, (ax, ay) and (bx, by), features less those of the vertex `da`, `db`.
    void add(float ax, float ay, const float* da, float bx, float by, const float* db) {
        const float det = ax * by - ay * bx;  // negative, as y grows downwards
        const float a = -0.5f * det;
        const float cx = (ax + bx) / 3, cy = (ay + by) / 3;
        area += a;
        tx += a * cx;
        ty += a * cy;
        tt += a * (cx * cx + cy * cy);
        for (int c = 0; c < C; ++c) {
            const float x = (by * da[c] - ay * db[c]) / det, y = (ax * db[c] - bx * da[c]) / det;
            gx[c] += a * x;
            gy[c] += a * y;
            gxx += a * x * x;
            gxy += a * x * y;
            gyy += a * y * y;
        }
    }

    Quadric<C> finish(float x, float y, const float* s, float lambda) const {
        Quadric<C> q;
        q.weight = area;
        q.sxx = lambda * area + gxx;
        q.sxy = gxy;
        q.syy = lambda * area + gyy;
        for (int c = 0; c < C; ++c) {
            q.gx[c] = gx[c] / area;
            q.gy[c] = gy[c] / area;
            q.sxx -= area * q.gx[c] * q.gx[c];
            q.sxy -= area * q.gx[c] * q.gy[c];
            q.syy -= area * q.gy[c] * q.gy[c];
        }
        const float det = q.sxx * q.syy - q.sxy * q.sxy;
        const float dx = lambda * (q.syy * tx - q.sxy * ty) / det,
                    dy = lambda * (q.sxx * ty - q.sxy * tx) / det;
        q.px = x + dx;
        q.py = y + dy;
        for (int c = 0; c < C; ++c) q.s[c] = s[c] + q.gx[c] * dx + q.gy[c] * dy;
        q.error = std::fmax(0.0f, lambda * (tt - dx * tx - dy * ty));
        return q;
    }
};

}  // namespace

template <int C>
std::vector<Quadric<C>> vertex_quadrics(const GridMesh& grid, const FeatureImage& gradients, float lambda) {
    const int w = grid.feature.width;
    std::vector<Quadric<C>> quadrics(grid.feature.pixel_count());
    parallel_blocks(0, grid.feature.height, 16, [&](int first, int last) {
        for (int y = first; y < last; ++y) {
            for (int x = 0; x < w; ++x) {
                const Ring ring = grid_ring(grid, x, y);
                const std::size_t v =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
                float d[kMaxValence][C], ox[kMaxValence], oy[kMaxValence];
                const float* own = gradients.pixel(v);
                for (int k = 0; k < ring.valence; ++k) {
                    const Id n = ring.neighbor[k];
                    ox[k] = static_cast<float>(static_cast<int>(n % static_cast<Id>(w)) - x);
                    oy[k] = static_cast<float>(static_cast<int>(n / static_cast<Id>(w)) - y);
                    for (int c = 0; c < C; ++c) d[k][c] = gradients.pixel(n)[c] - own[c];
                }
                Accumulator<C> sum;
                for (int k = 0; k < ring.valence - (ring.border() ? 1 : 0); ++k) {
                    const int m = k + 1 == ring.valence ? 0 : k + 1;
                    sum.add(ox[k], oy[k], d[k], ox[m], oy[m], d[m]);
                }
                quadrics[v] = sum.finish(ring.x, ring.y, grid.feature.pixel(v), lambda);
            }
        }
    });
    return quadrics;
}

namespace {

// Sums over the faces of any mesh. own(v): features at vertex v; slope(v, k, out): those of the vertex's k-th
// neighbour less its own, from which gradients come.
template <int C, class Own, class Slope>
std::vector<Quadric<C>> quadrics_over(const RingMesh& rings, float lambda, const Own& own,
                                      const Slope& slope) {
    std::vector<Quadric<C>> quadrics(rings.size());
    parallel_blocks(0, static_cast<int>(rings.size()), 1 << 14, [&](int first, int last) {
        for (Id v = static_cast<Id>(first); v < static_cast<Id>(last); ++v) {
            const Ring& ring = rings[v];
            if (!ring.live()) continue;
            float d[kMaxValence][C], ox[kMaxValence], oy[kMaxValence];
            for (int k = 0; k < ring.valence; ++k) {
                const Ring& n = rings[ring.neighbor[k]];
                ox[k] = n.x - ring.x;
                oy[k] = n.y - ring.y;
                slope(v, k, d[k]);
            }
            Accumulator<C> sum;
            for (int k = 0; k < ring.valence - (ring.border() ? 1 : 0); ++k) {
                const int m = k + 1 == ring.valence ? 0 : k + 1;
                sum.add(ox[k], oy[k], d[k], ox[m], oy[m], d[m]);
            }
            float s[C];
            own(v, s);
            quadrics[v] = sum.finish(ring.x, ring.y, s, lambda);
        }
    });
    return quadrics;
}

}  // namespace

template <int C>
std::vector<Quadric<C>> vertex_quadrics(const GridMesh& grid, const RingMesh& rings,
                                        const FeatureImage& gradients, float lambda) {
    return quadrics_over<C>(
        rings, lambda, [&](Id v, float* s) { std::copy_n(grid.feature.pixel(v), C, s); },
        [&](Id v, int k, float* out) {
            const float *from = gradients.pixel(v), *to = gradients.pixel(rings[v].neighbor[k]);
            for (int c = 0; c < C; ++c) out[c] = to[c] - from[c];
        });
}

template <int C>
std::vector<Quadric<C>> current_quadrics(const RingMesh& rings, const std::vector<Quadric<C>>& before,
                                         float lambda) {
    const auto feature = [&](Id v, int c) { return before[v].feature(c, rings[v].x, rings[v].y); };
    return quadrics_over<C>(
        rings, lambda,
        [&](Id v, float* s) {
            for (int c = 0; c < C; ++c) s[c] = feature(v, c);
        },
        [&](Id v, int k, float* out) {
            for (int c = 0; c < C; ++c) out[c] = feature(rings[v].neighbor[k], c) - feature(v, c);
        });
}

template std::vector<Quadric<3>> vertex_quadrics<3>(const GridMesh&, const FeatureImage&, float);
template std::vector<Quadric<8>> vertex_quadrics<8>(const GridMesh&, const FeatureImage&, float);
template std::vector<Quadric<16>> vertex_quadrics<16>(const GridMesh&, const FeatureImage&, float);
template std::vector<Quadric<3>> vertex_quadrics<3>(const GridMesh&, const RingMesh&, const FeatureImage&,
                                                    float);
template std::vector<Quadric<8>> vertex_quadrics<8>(const GridMesh&, const RingMesh&, const FeatureImage&,
                                                    float);
template std::vector<Quadric<16>> vertex_quadrics<16>(const GridMesh&, const RingMesh&, const FeatureImage&,
                                                      float);
template std::vector<Quadric<3>> current_quadrics<3>(const RingMesh&, const std::vector<Quadric<3>>&, float);
template std::vector<Quadric<8>> current_quadrics<8>(const RingMesh&, const std::vector<Quadric<8>>&, float);
template std::vector<Quadric<16>> current_quadrics<16>(const RingMesh&, const std::vector<Quadric<16>>&,
                                                       float);

}  // namespace imgmesh
