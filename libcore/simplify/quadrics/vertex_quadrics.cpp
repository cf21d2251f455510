// Steps: (1) the faces around each vertex are summed, their gradients from the smoothed copy; (2) the sum is
// brought into canonical form. Colour quadrics of pixels that are on no side are made eight at a time.
// Sources: paper sec. 3.2; Hoppe 1999; the form is derived in docs/decisions/0001-canonical-quadric.md.
#include "libcore/simplify/quadrics/vertex_quadrics.h"

#include <algorithm>
#include <type_traits>

#include "libcore/base/parallel.h"
#include "libcore/mesh/ring_mesh.h"
#include "libcore/simplify/quadrics/quadric_lanes.h"

namespace imgmesh {
namespace {

// What a thread takes at a time. Results do not depend on it.
constexpr int kRows = 16, kVertices = 1 << 14;

// With a the area of face f, t its centroid less the vertex, g its gradient, summed over the faces around the
// vertex:
//   W = sum a,  G = sum a g / W,  S = lambda W I + sum a g'g - W G'G,  q = S^-1 lambda sum a t,
//   e = lambda sum a |t|^2 - q' lambda sum a t.
// For one vertex (T = float) or eight (T = Float8).
template <int C, typename T>
struct Accumulator {
    T area = {}, tx = {}, ty = {}, tt = {};
    T gx[C] = {}, gy[C] = {};
    T gxx = {}, gxy = {}, gyy = {};

    // A face of area a, its centroid at (cx, cy) from the vertex.
    IMGMESH_INLINE void add_place(T a, float cx, float cy) {
        area += a;
        tx += a * cx;
        ty += a * cy;
        tt += a * (cx * cx + cy * cy);
    }
    // Its gradient of feature c.
    IMGMESH_INLINE void add_gradient(T a, int c, T x, T y) {
        gx[c] += a * x;
        gy[c] += a * y;
        gxx += a * x * x;
        gxy += a * x * y;
        gyy += a * y * y;
    }
    // A face: corners at 0, (ax, ay) and (bx, by), features less those of the vertex `da`, `db`.
    void add(float ax, float ay, const float* da, float bx, float by,
             const float* db) requires std::is_same_v<T, float> {
        const float det = ax * by - ay * bx;  // negative, as y grows downwards
        const float a = -0.5f * det;
        add_place(a, (ax + bx) / 3, (ay + by) / 3);
        for (int c = 0; c < C; ++c)
            add_gradient(a, c, (by * da[c] - ay * db[c]) / det, (ax * db[c] - bx * da[c]) / det);
    }
    // The faces around a vertex, of whose k-th neighbour (ox[k], oy[k]) is the offset and d[k] are the
    // features less its own.
    void add_faces(const Ring& ring, const float* ox, const float* oy,
                   const float (*d)[C]) requires std::is_same_v<T, float> {
        for (int k = 0; k < ring.valence - (ring.border() ? 1 : 0); ++k) {
            const int m = k + 1 == ring.valence ? 0 : k + 1;
            add(ox[k], oy[k], d[k], ox[m], oy[m], d[m]);
        }
    }

    // The quadric of a vertex at (x, y) with features s.
    IMGMESH_INLINE Quadric<C, T> finish(T x, T y, const T* s, float lambda) const {
        Quadric<C, T> q;
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
        const T scale = lambda / (q.sxx * q.syy - q.sxy * q.sxy);
        const T dx = scale * (q.syy * tx - q.sxy * ty), dy = scale * (q.sxx * ty - q.sxy * tx);
        q.px = x + dx;
        q.py = y + dy;
        for (int c = 0; c < C; ++c) q.s[c] = s[c] + q.gx[c] * dx + q.gy[c] * dy;
        const T error = lambda * (tt - dx * tx - dy * ty);
        q.error = error > T{} ? error : T{};
        return q;
    }
};

template <int C>
Quadric<C> quadric_at(const GridMesh& grid, const FeaturePatch& gradients, float lambda, int x, int y) {
    const Id w = static_cast<Id>(grid.feature.width);
    const Ring ring = grid_ring(grid, x, y);
    const Id v = static_cast<Id>(y) * w + static_cast<Id>(x);
    float d[kMaxValence][C], ox[kMaxValence], oy[kMaxValence];
    const float* own = gradients.pixel(x, y);
    for (int k = 0; k < ring.valence; ++k) {
        const Id n = ring.neighbor[k];
        const int nx = static_cast<int>(n % w), ny = static_cast<int>(n / w);
        ox[k] = static_cast<float>(nx - x);
        oy[k] = static_cast<float>(ny - y);
        for (int c = 0; c < C; ++c) d[k][c] = gradients.pixel(nx, ny)[c] - own[c];
    }
    Accumulator<C, float> sum;
    sum.add_faces(ring, ox, oy, d);
    return sum.finish(ring.x, ring.y, grid.feature.pixel(v), lambda);
}

// Colours of the pixel (x, y) and the seven to its right, channel by channel.
struct EightColors {
    Float8 c[3];

    IMGMESH_INLINE explicit EightColors(const float* first) {
        const Float8 p = load8(first), q = load8(first + 8), r = load8(first + 16);
        c[0] = __builtin_shufflevector(__builtin_shufflevector(p, q, 0, 3, 6, 9, 12, 15, 0, 0), r, 0, 1, 2, 3,
                                       4, 5, 10, 13);
        c[1] = __builtin_shufflevector(__builtin_shufflevector(p, q, 1, 4, 7, 10, 13, 0, 0, 0), r, 0, 1, 2, 3,
                                       4, 8, 11, 14);
        c[2] = __builtin_shufflevector(__builtin_shufflevector(p, q, 2, 5, 8, 11, 14, 0, 0, 0), r, 0, 1, 2, 3,
                                       4, 9, 12, 15);
    }
};

// Whether the cells (x, y) to (x + 7, y) have the falling diagonal, as 1 or 0.
IMGMESH_INLINE Float8 eight_falling(const GridMesh& grid, int x, int y) {
    Float8 out;
    for (int lane = 0; lane < 8; ++lane) out[lane] = grid.falling_diagonal(x + lane, y) ? 1.0f : 0.0f;
    return out;
}

// quadric_at() for (x, y) to (x + 7, y), none of them on a side. Of the cell that a pixel is a corner of, it
// has one triangle with half the cell's sides for its own, or two that the diagonal from the pixel divides.
IMGMESH_INLINE void eight_quadrics(const GridMesh& grid, const FeaturePatch& gradients, float lambda, int x,
                                   int y, Quadric<3>* out) {
    Accumulator<3, Float8> sum;
    const EightColors here(gradients.pixel(x, y)), east(gradients.pixel(x + 1, y)),
        west(gradients.pixel(x - 1, y));
    // The cells of one side of the row: `beside` is the row above (step -1) or below (1).
    for (const int step : {-1, 1}) {
        const float dy = static_cast<float>(step);
        const EightColors beside(gradients.pixel(x, y + step)), east_of(gradients.pixel(x + 1, y + step)),
            west_of(gradients.pixel(x - 1, y + step));
        const int row = step < 0 ? y - 1 : y;
        const Float8 falling_east = eight_falling(grid, x, row),
                     falling_west = eight_falling(grid, x - 1, row);
        // A cell's diagonal comes from the pixel where it falls to the right below or to the left above.
        const Float8 two_east = step > 0 ? falling_east : 1 - falling_east,
                     two_west = step > 0 ? 1 - falling_west : falling_west;
        for (const int side : {-1, 1}) {
            const float dx = static_cast<float>(side);
            const Float8 two = side > 0 ? two_east : two_west;
            const EightColors &level = side > 0 ? east : west, &corner = side > 0 ? east_of : west_of;
            // One triangle: here, level, beside. Two: here, beside, corner and here, level, corner.
            const Float8 one_half = 0.5f * (1 - two), two_halves = 0.5f * two;
            sum.add_place(one_half, dx / 3, dy / 3);
            sum.add_place(two_halves, dx / 3, 2 * dy / 3);
            sum.add_place(two_halves, 2 * dx / 3, dy / 3);
            for (int c = 0; c < 3; ++c) {
                const Float8 along_x = dx * (level.c[c] - here.c[c]),
                             along_y = dy * (beside.c[c] - here.c[c]);
                const Float8 far_x = dx * (corner.c[c] - beside.c[c]),
                             far_y = dy * (corner.c[c] - level.c[c]);
                sum.add_gradient(one_half, c, along_x, along_y);
                sum.add_gradient(two_halves, c, far_x, along_y);
                sum.add_gradient(two_halves, c, along_x, far_y);
            }
        }
    }
    const EightColors own(grid.feature.pixel(x, y));
    write_in_turn(sum.finish(grid.origin_x + static_cast<float>(x) + Float8{0, 1, 2, 3, 4, 5, 6, 7},
                             Float8{} + (grid.origin_y + static_cast<float>(y)), own.c, lambda),
                  out);
}

// Pixels [x, right) of row y as long as there are eight of them inside the image; returns where it stopped.
IMGMESH_INLINE int row_of_eights(const GridMesh& grid, const FeaturePatch& gradients, float lambda, int x,
                                 int y, int right, Quadric<3>* out) {
    for (; x + 8 <= right && x + 8 < grid.feature.width; x += 8, out += 8)
        eight_quadrics(grid, gradients, lambda, x, y, out);
    return x;
}
int row_portably(const GridMesh& grid, const FeaturePatch& gradients, float lambda, int x, int y, int right,
                 Quadric<3>* out) {
    return row_of_eights(grid, gradients, lambda, x, y, right, out);
}
#if defined(__x86_64__)
__attribute__((target("avx2"))) int row_avx2(const GridMesh& grid, const FeaturePatch& gradients,
                                             float lambda, int x, int y, int right, Quadric<3>* out) {
    return row_of_eights(grid, gradients, lambda, x, y, right, out);
}
#endif

int inner_row(const GridMesh& grid, const FeaturePatch& gradients, float lambda, int x, int y, int right,
              Quadric<3>* out) {
    if (x < 1 || y < 1 || y + 1 >= grid.feature.height) return x;
#if defined(__x86_64__)
    static const bool kAvx2 = has_avx2();
    if (kAvx2) return row_avx2(grid, gradients, lambda, x, y, right, out);
#endif
    return row_portably(grid, gradients, lambda, x, y, right, out);
}

}  // namespace

template <int C>
void vertex_quadrics(const GridMesh& grid, const FeaturePatch& gradients, float lambda, const PixelRect& rect,
                     Quadric<C>* out) {
    for (int y = rect.top; y < rect.bottom; ++y) {
        int x = rect.left;
        while (x < rect.right) {
            if constexpr (C == 3) {
                const int after = inner_row(grid, gradients, lambda, x, y, rect.right, out);
                out += after - x;
                x = after;
                if (x == rect.right) break;
            }
            *out++ = quadric_at<C>(grid, gradients, lambda, x++, y);
        }
    }
}

template <int C>
std::vector<Quadric<C>> vertex_quadrics(const GridMesh& grid, const FeaturePatch& gradients, float lambda) {
    const int w = grid.feature.width;
    std::vector<Quadric<C>> quadrics(grid.feature.pixel_count());
    parallel_blocks(0, grid.feature.height, kRows, [&](int first, int last) {
        vertex_quadrics(grid, gradients, lambda, {0, first, w, last},
                        quadrics.data() + static_cast<std::size_t>(first) * static_cast<std::size_t>(w));
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
    parallel_blocks(0, static_cast<int>(rings.size()), kVertices, [&](int first, int last) {
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
            Accumulator<C, float> sum;
            sum.add_faces(ring, ox, oy, d);
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
                                        const std::vector<Id>& number, const FeaturePatch& gradients,
                                        float lambda) {
    const auto in_grid = [&](Id v) { return number.empty() ? v : number[v]; };
    const auto at = [&](Id v) { return gradients.of_vertex(grid, in_grid(v)); };
    return quadrics_over<C>(
        rings, lambda, [&](Id v, float* s) { std::copy_n(grid.feature.pixel(in_grid(v)), C, s); },
        [&](Id v, int k, float* out) {
            const float *from = at(v), *to = at(rings[v].neighbor[k]);
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

template void vertex_quadrics<3>(const GridMesh&, const FeaturePatch&, float, const PixelRect&, Quadric<3>*);
template void vertex_quadrics<8>(const GridMesh&, const FeaturePatch&, float, const PixelRect&, Quadric<8>*);
template void vertex_quadrics<16>(const GridMesh&, const FeaturePatch&, float, const PixelRect&,
                                  Quadric<16>*);
template std::vector<Quadric<3>> vertex_quadrics<3>(const GridMesh&, const FeaturePatch&, float);
template std::vector<Quadric<8>> vertex_quadrics<8>(const GridMesh&, const FeaturePatch&, float);
template std::vector<Quadric<16>> vertex_quadrics<16>(const GridMesh&, const FeaturePatch&, float);
template std::vector<Quadric<3>> vertex_quadrics<3>(const GridMesh&, const RingMesh&, const std::vector<Id>&,
                                                    const FeaturePatch&, float);
template std::vector<Quadric<8>> vertex_quadrics<8>(const GridMesh&, const RingMesh&, const std::vector<Id>&,
                                                    const FeaturePatch&, float);
template std::vector<Quadric<16>> vertex_quadrics<16>(const GridMesh&, const RingMesh&,
                                                      const std::vector<Id>&, const FeaturePatch&, float);
template std::vector<Quadric<3>> current_quadrics<3>(const RingMesh&, const std::vector<Quadric<3>>&, float);
template std::vector<Quadric<8>> current_quadrics<8>(const RingMesh&, const std::vector<Quadric<8>>&, float);
template std::vector<Quadric<16>> current_quadrics<16>(const RingMesh&, const std::vector<Quadric<16>>&,
                                                       float);

}  // namespace imgmesh
