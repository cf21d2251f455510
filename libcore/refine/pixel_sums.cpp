#include "libcore/refine/pixel_sums.h"

#include <algorithm>

#include "libcore/base/dot.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/base/simd.h"
#include "libcore/refine/face_spans.h"

namespace imgmesh {
namespace {

// Colour and weights of a face relative to its first corner: the colour is f + fx dx + fy dy, the weight of
// the second corner ux dx + uy dy, that of the third vx dx + vy dy.
struct Plane {
    float ax, ay, f[3], fx[3], fy[3], ux, uy, vx, vy;

    Plane(const Corner& a, const Corner& b, const Corner& c) {
        const double bx = double(b.position.x()) - a.position.x(),
                     by = double(b.position.y()) - a.position.y();
        const double cx = double(c.position.x()) - a.position.x(),
                     cy = double(c.position.y()) - a.position.y();
        const double inverse = 1 / (bx * cy - by * cx);
        ax = a.position.x();
        ay = a.position.y();
        ux = static_cast<float>(cy * inverse);
        uy = static_cast<float>(-cx * inverse);
        vx = static_cast<float>(-by * inverse);
        vy = static_cast<float>(bx * inverse);
        for (int k = 0; k < 3; ++k) {
            const float db = b.color[k] - a.color[k], dc = c.color[k] - a.color[k];
            f[k] = a.color[k];
            fx[k] = ux * db + vx * dc;
            fy[k] = uy * db + vy * dc;
        }
    }
};

constexpr Float8 kLane = {0, 1, 2, 3, 4, 5, 6, 7};

// Returns the sums over the lanes of each of eight vectors.
IMGMESH_INLINE Float8 totals(const Float8 (&v)[8]) {
    Float8 pair[4], four[2];
    for (int k = 0; k < 4; ++k) {
        const Float8 &a = v[2 * k], &b = v[2 * k + 1];
        pair[k] = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13) +
                  __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    }
    for (int k = 0; k < 2; ++k) {
        const Float8 &a = pair[2 * k], &b = pair[2 * k + 1];
        four[k] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13) +
                  __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    }
    return __builtin_shufflevector(four[0], four[1], 0, 1, 2, 3, 8, 9, 10, 11) +
           __builtin_shufflevector(four[0], four[1], 4, 5, 6, 7, 12, 13, 14, 15);
}
IMGMESH_INLINE double total(const Float8& v) {
    const float a = v[0] + v[4], b = v[1] + v[5], c = v[2] + v[6], d = v[3] + v[7];
    return double(a + c) + double(b + d);
}

// Calls chunk(e, dx, dy, inside) for every eight pixels; dx is undefined where not inside, and e is 0.
// `band` is called after at most FaceSpans::kBand rows, with their spans.
template <bool kMasked, class Chunk, class Band>
IMGMESH_INLINE void for_each_chunk(const ImagePlanes& image, const Plane& plane, const Corner& a,
                                   const Corner& b, const Corner& c, Chunk&& chunk, Band&& band) {
    FaceSpans spans(a.position, b.position, c.position, image.width, image.height);
    while (const int rows = spans.next()) {
        for (int r = 0; r < rows; ++r) {
            const int begin = spans.begin(r), pixels = spans.end(r) - begin;
            const std::size_t start =
                static_cast<std::size_t>(spans.y() + r) * static_cast<std::size_t>(image.width) +
                static_cast<std::size_t>(begin);
            const float dy = static_cast<float>(spans.y() + r) - plane.ay;
            const float dx = static_cast<float>(begin) - plane.ax;
            Float8 row[3];
            for (int k = 0; k < 3; ++k) row[k] = plane.f[k] + plane.fy[k] * dy + Float8{};
            for (int i = 0; i < pixels; i += 8) {
                const Float8 dx8 = dx + static_cast<float>(i) + kLane;
                Int8 inside = kLane < static_cast<float>(pixels - i);
                if (kMasked)
                    inside &= load8(image.inside.data() + start + static_cast<std::size_t>(i)) > 0.0f;
                Float8 e[3];
                for (std::size_t k = 0; k < 3; ++k) {
                    const Float8 want = load8(image.channel[k].data() + start + static_cast<std::size_t>(i));
                    e[k] = row[k] + plane.fx[k] * dx8 - want;
                    e[k] = inside ? e[k] : Float8{};
                }
                chunk(e, dx8, dy, inside);
            }
        }
        band(spans, rows);
    }
}

template <bool kMasked>
IMGMESH_INLINE double squared_error_of(const ImagePlanes& image, const Corner& a, const Corner& b,
                                       const Corner& c) {
    double sum = 0;
    Float8 ee = {};
    for_each_chunk<kMasked>(
        image, Plane(a, b, c), a, b, c,
        [&](const Float8* e, const Float8&, float, const Int8&)
            __attribute__((always_inline)) { ee += e[0] * e[0] + e[1] * e[1] + e[2] * e[2]; },
        [&](const FaceSpans&, int) __attribute__((always_inline)) {
            sum += total(ee);
            ee = Float8{};
        });
    return sum;
}

// Sums of 1, dx, dy, their squares and products over the pixels of a face.
struct Areas {
    double one = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

    // Without a mask a row's sums are known from its ends.
    IMGMESH_INLINE void add(const FaceSpans& spans, int rows, double ax, double ay) {
        for (int r = 0; r < rows; ++r) {
            const int pixels = spans.end(r) - spans.begin(r);
            if (pixels <= 0) continue;
            const double n = pixels, from = spans.begin(r) - ax, dy = spans.y() + r - ay;
            const double half = 0.5 * n * (n - 1), nx = n * from;
            const double x_row = nx + half;
            one += n;
            x += x_row;
            xx += from * (nx + 2 * half) + half * (2 * n - 1) * (1.0 / 3);
            y += dy * n;
            xy += dy * x_row;
            yy += dy * dy * n;
        }
    }
};

// Source: the weights are linear in dx and dy, so that the sums follow from those of e, dx e and dy e, and
// from sums that do not need the image.
template <bool kMasked>
IMGMESH_INLINE FaceSums face_sums_of(const ImagePlanes& image, const Corner& a, const Corner& b,
                                     const Corner& c) {
    const Plane plane(a, b, c);
    FaceSums sums;
    double squares = 0;
    Areas areas;
    Float8 part[8] = {}, y2 = {}, ee = {};  // e, dx e, dy e of three channels: the last one is y2
    Float8 area[8] = {};
    double linear[9] = {};
    for_each_chunk<kMasked>(
        image, plane, a, b, c,
        [&](const Float8* e, const Float8& dx, float dy, const Int8& inside) __attribute__((always_inline)) {
            ee += e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
            for (int k = 0; k < 3; ++k) {
                part[k] += e[k];
                part[3 + k] += dx * e[k];
            }
            for (int k = 0; k < 2; ++k) part[6 + k] += dy * e[k];
            y2 += dy * e[2];
            if (kMasked) {
                const Float8 one = inside ? 1 + Float8{} : Float8{}, x = inside ? dx : Float8{};
                area[0] += one;
                area[1] += x;
                area[2] += dy * one;
                area[3] += x * x;
                area[4] += dy * x;
                area[5] += dy * dy * one;
            }
        },
        [&](const FaceSpans& spans, int rows) __attribute__((always_inline)) {
            const Float8 now = totals(part);
            for (int k = 0; k < 8; ++k) {
                linear[k] += now[k];
                part[k] = Float8{};
            }
            linear[8] += total(y2);
            squares += total(ee);
            ee = y2 = Float8{};
            if (!kMasked) {
                areas.add(spans, rows, a.position.x(), a.position.y());
                return;
            }
            const Float8 all = totals(area);
            areas.one += all[0];
            areas.x += all[1];
            areas.y += all[2];
            areas.xx += all[3];
            areas.xy += all[4];
            areas.yy += all[5];
            for (Float8& v : area) v = Float8{};
        });
    // The corners' weights are at + x dx + y dy.
    const double x[3] = {-double(plane.ux) - plane.vx, plane.ux, plane.vx},
                 y[3] = {-double(plane.uy) - plane.vy, plane.uy, plane.vy}, at[3] = {1, 0, 0};
    sums.ee = static_cast<float>(squares);
    for (int i = 0; i < 3; ++i) {
        const double one = at[i] * areas.one + x[i] * areas.x + y[i] * areas.y,
                     dx = at[i] * areas.x + x[i] * areas.xx + y[i] * areas.xy,
                     dy = at[i] * areas.y + x[i] * areas.xy + y[i] * areas.yy;
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        sums.square[i] = static_cast<float>(at[i] * one + x[i] * dx + y[i] * dy);
        sums.product[k] = static_cast<float>(at[j] * one + x[j] * dx + y[j] * dy);
        for (int m = 0; m < 3; ++m)
            sums.we[i][m] =
                static_cast<float>(at[i] * linear[m] + x[i] * linear[3 + m] + y[i] * linear[6 + m]);
    }
    return sums;
}

template <bool kMasked>
IMGMESH_INLINE FaceHats face_hats_of(const ImagePlanes& image, const Corner& a, const Corner& b,
                                     const Corner& c, const std::array<float, 3>& at) {
    const Plane plane(a, b, c);
    FaceHats hats;
    Float8 he[3][4] = {}, hh[4] = {};
    float from[3], to[3];  // the hats' slopes, as weights of an edge's second and first end
    for (std::size_t i = 0; i < 3; ++i) {
        from[i] = 1 / at[i];
        to[i] = 1 / (1 - at[i]);
    }
    for_each_chunk<kMasked>(
        image, plane, a, b, c,
        [&](const Float8* e, const Float8& dx, float dy, const Int8& inside) __attribute__((always_inline)) {
            const Float8 w1 = plane.uy * dy + plane.ux * dx, w2 = plane.vy * dy + plane.vx * dx,
                         w0 = 1 - w1 - w2;
            const auto lesser = [](const Float8& p, const Float8& q) __attribute__((always_inline)) {
                return p < q ? p : q;
            };
            const Float8 hat[4] = {
                lesser(w2 * from[0], w1 * to[0]),
                lesser(w0 * from[1], w2 * to[1]),
                lesser(w1 * from[2], w0 * to[2]),
                3 * lesser(lesser(w0, w1), w2),
            };
            for (int i = 0; i < 4; ++i) {
                const Float8 h = inside ? hat[i] : Float8{};
                hh[i] += h * h;
                for (int k = 0; k < 3; ++k) he[k][i] += h * e[k];
            }
        },
        [&](const FaceSpans&, int) __attribute__((always_inline)) {
            const Float8 first = totals({he[0][0], he[0][1], he[0][2], he[0][3], he[1][0], he[1][1], he[1][2],
                                         he[1][3]}),
                         second =
                             totals({he[2][0], he[2][1], he[2][2], he[2][3], hh[0], hh[1], hh[2], hh[3]});
            for (int i = 0; i < 4; ++i) {
                HatSums& sums = i < 3 ? hats.edge[static_cast<std::size_t>(i)] : hats.center;
                sums.he += Vec3f(first[i], first[4 + i], second[i]);
                sums.hh += second[4 + i];
                hh[i] = he[0][i] = he[1][i] = he[2][i] = Float8{};
            }
        });
    return hats;
}

// Each function for images without a mask and for others.
IMGMESH_INLINE double squared_error_any(const ImagePlanes& image, const Corner& a, const Corner& b,
                                        const Corner& c) {
    return image.inside.empty() ? squared_error_of<false>(image, a, b, c)
                                : squared_error_of<true>(image, a, b, c);
}
IMGMESH_INLINE FaceSums face_sums_any(const ImagePlanes& image, const Corner& a, const Corner& b,
                                      const Corner& c) {
    return image.inside.empty() ? face_sums_of<false>(image, a, b, c) : face_sums_of<true>(image, a, b, c);
}
IMGMESH_INLINE FaceHats face_hats_any(const ImagePlanes& image, const Corner& a, const Corner& b,
                                      const Corner& c, const std::array<float, 3>& at) {
    return image.inside.empty() ? face_hats_of<false>(image, a, b, c, at)
                                : face_hats_of<true>(image, a, b, c, at);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) double squared_error_avx2(const ImagePlanes& image, const Corner& a,
                                                          const Corner& b, const Corner& c) {
    return squared_error_any(image, a, b, c);
}
__attribute__((target("avx2"))) FaceSums face_sums_avx2(const ImagePlanes& image, const Corner& a,
                                                        const Corner& b, const Corner& c) {
    return face_sums_any(image, a, b, c);
}
__attribute__((target("avx2"))) FaceHats face_hats_avx2(const ImagePlanes& image, const Corner& a,
                                                        const Corner& b, const Corner& c,
                                                        const std::array<float, 3>& at) {
    return face_hats_any(image, a, b, c, at);
}
const bool kAvx2 = has_avx2();
#endif

}  // namespace

ImagePlanes::ImagePlanes(const FeatureImage& image, const Mask& mask) : GridSize(image) {
    constexpr std::size_t kPadding = 8;
    constexpr int kRows = 64;
    const std::size_t pixels = image.pixel_count(), columns = static_cast<std::size_t>(width);
    for (std::vector<float>& plane : channel) plane = parallel_vector<float>(pixels + kPadding);
    if (!mask.empty()) inside = parallel_vector<float>(pixels + kPadding);
    parallel_blocks(0, height, kRows, [&](int begin, int end) {
        for (std::size_t i = static_cast<std::size_t>(begin) * columns;
             i < static_cast<std::size_t>(end) * columns; ++i) {
            for (std::size_t k = 0; k < 3; ++k) channel[k][i] = image.pixel(i)[k];
            if (!mask.empty()) inside[i] = mask.contains(i) ? 1.0f : 0.0f;
        }
    });
}

void FaceSums::shift(std::size_t i, const Vec3d& change) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const double error = ee + 2 * dot(change, Vec3d(we[i].cast<double>())) + square[i] * dot(change, change);
    ee = static_cast<float>(std::max(0.0, error));
    const Vec3f shifted = change.cast<float>();
    we[i] += square[i] * shifted;
    we[j] += product[k] * shifted;
    we[k] += product[j] * shifted;
}

double squared_error(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c) {
#if defined(__x86_64__)
    if (kAvx2) return squared_error_avx2(image, a, b, c);
#endif
    return squared_error_any(image, a, b, c);
}

FaceSums face_sums(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c) {
#if defined(__x86_64__)
    if (kAvx2) return face_sums_avx2(image, a, b, c);
#endif
    return face_sums_any(image, a, b, c);
}

FaceHats face_hats(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c,
                   const std::array<float, 3>& at) {
#if defined(__x86_64__)
    if (kAvx2) return face_hats_avx2(image, a, b, c, at);
#endif
    return face_hats_any(image, a, b, c, at);
}

}  // namespace imgmesh
