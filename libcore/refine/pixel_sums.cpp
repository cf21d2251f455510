#include "libcore/refine/pixel_sums.h"

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
// Float sums are added up in double after this many rows.
constexpr int kFlushRows = 32;

IMGMESH_INLINE double total(const Float8& v) {
    const double a = double(v[0]) + v[4], b = double(v[1]) + v[5], c = double(v[2]) + v[6],
                 d = double(v[3]) + v[7];
    return (a + c) + (b + d);
}

// Calls chunk(e, dx, dy, inside) for every eight pixels; e and dx are undefined where not inside.
template <class Chunk, class Flush>
IMGMESH_INLINE void for_each_chunk(const ImagePlanes& image, const Plane& plane, const Corner& a,
                                   const Corner& b, const Corner& c, Chunk&& chunk, Flush&& flush) {
    int rows = 0;
    for_each_span(
        a.position, b.position, c.position, image.width,
        image.height, [&](int y, int begin, int end) __attribute__((always_inline)) {
            const std::size_t start = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                      static_cast<std::size_t>(begin);
            const float dy = static_cast<float>(y) - plane.ay;
            const float dx = static_cast<float>(begin) - plane.ax;
            for (int i = 0; i < end - begin; i += 8) {
                const Float8 dx8 = dx + static_cast<float>(i) + kLane;
                Int8 inside = kLane < static_cast<float>(end - begin - i);
                if (!image.inside.empty())
                    inside &= load8(image.inside.data() + start + static_cast<std::size_t>(i)) > 0.0f;
                Float8 e[3];
                for (std::size_t k = 0; k < 3; ++k) {
                    const Float8 want = load8(image.channel[k].data() + start + static_cast<std::size_t>(i));
                    e[k] = plane.f[k] + plane.fy[k] * dy + plane.fx[k] * dx8 - want;
                    e[k] = inside ? e[k] : Float8{};
                }
                chunk(e, dx8, dy, inside, y, begin + i);
            }
            if (++rows % kFlushRows == 0) flush();
        });
    flush();
}

IMGMESH_INLINE CornerSums corner_sums_of(const ImagePlanes& image, const Corner& a, const Corner& b,
                                         const Corner& c) {
    const Plane plane(a, b, c);
    const float wx = -plane.ux - plane.vx, wy = -plane.uy - plane.vy;
    CornerSums sums;
    Float8 ee = {}, ww = {}, we[3] = {};
    for_each_chunk(
        image, plane, a, b, c,
        [&](const Float8* e, const Float8& dx, float dy, const Int8& inside, int, int)
            __attribute__((always_inline)) {
                Float8 w = 1 + wy * dy + wx * dx;
                w = inside ? w : Float8{};
                ww += w * w;
                ee += e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
                for (int k = 0; k < 3; ++k) we[k] += w * e[k];
            },
        [&]() __attribute__((always_inline)) {
            sums.ee += total(ee);
            sums.ww += total(ww);
            for (int k = 0; k < 3; ++k) sums.we[k] += total(we[k]);
            ee = ww = we[0] = we[1] = we[2] = Float8{};
        });
    return sums;
}

IMGMESH_INLINE double squared_error_of(const ImagePlanes& image, const Corner& a, const Corner& b,
                                       const Corner& c) {
    double sum = 0;
    Float8 ee = {};
    for_each_chunk(
        image, Plane(a, b, c), a, b, c,
        [&](const Float8* e, const Float8&, float, const Int8&, int, int)
            __attribute__((always_inline)) { ee += e[0] * e[0] + e[1] * e[1] + e[2] * e[2]; },
        [&]() __attribute__((always_inline)) {
            sum += total(ee);
            ee = Float8{};
        });
    return sum;
}

IMGMESH_INLINE FaceSums face_sums_of(const ImagePlanes& image, const Corner& a, const Corner& b,
                                     const Corner& c) {
    const Plane plane(a, b, c);
    FaceSums sums;
    Float8 ee = {}, ww[3][3] = {}, we[3][3] = {};
    for_each_chunk(
        image, plane, a, b, c,
        [&](const Float8* e, const Float8& dx, float dy, const Int8& inside, int, int)
            __attribute__((always_inline)) {
                Float8 w[3];
                w[1] = plane.uy * dy + plane.ux * dx;
                w[2] = plane.vy * dy + plane.vx * dx;
                w[0] = 1 - w[1] - w[2];
                ee += e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
                for (int i = 0; i < 3; ++i) {
                    w[i] = inside ? w[i] : Float8{};
                    for (int j = 0; j <= i; ++j) ww[i][j] += w[i] * w[j];
                    for (int k = 0; k < 3; ++k) we[i][k] += w[i] * e[k];
                }
            },
        [&]() __attribute__((always_inline)) {
            sums.ee += total(ee);
            ee = Float8{};
            for (int i = 0; i < 3; ++i) {
                for (int j = 0; j <= i; ++j) {
                    sums.ww[i][j] += total(ww[i][j]);
                    sums.ww[j][i] = sums.ww[i][j];
                    ww[i][j] = Float8{};
                }
                for (int k = 0; k < 3; ++k) {
                    sums.we[i][k] += total(we[i][k]);
                    we[i][k] = Float8{};
                }
            }
        });
    return sums;
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) CornerSums corner_sums_avx2(const ImagePlanes& image, const Corner& a,
                                                            const Corner& b, const Corner& c) {
    return corner_sums_of(image, a, b, c);
}
__attribute__((target("avx2"))) double squared_error_avx2(const ImagePlanes& image, const Corner& a,
                                                          const Corner& b, const Corner& c) {
    return squared_error_of(image, a, b, c);
}
__attribute__((target("avx2"))) FaceSums face_sums_avx2(const ImagePlanes& image, const Corner& a,
                                                        const Corner& b, const Corner& c) {
    return face_sums_of(image, a, b, c);
}
const bool kAvx2 = has_avx2();
#endif

}  // namespace

ImagePlanes::ImagePlanes(const FeatureImage& image, const Mask& mask)
    : width(image.width), height(image.height) {
    constexpr std::size_t kPadding = 8;
    for (std::size_t k = 0; k < 3; ++k) {
        channel[k].resize(image.pixel_count() + kPadding);
        for (std::size_t i = 0; i < image.pixel_count(); ++i) channel[k][i] = image.pixel(i)[k];
    }
    if (mask.empty()) return;
    inside.resize(image.pixel_count() + kPadding);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) inside[i] = mask.contains(i) ? 1.0f : 0.0f;
}

CornerSums corner_sums(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c) {
#if defined(__x86_64__)
    if (kAvx2) return corner_sums_avx2(image, a, b, c);
#endif
    return corner_sums_of(image, a, b, c);
}

double squared_error(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c) {
#if defined(__x86_64__)
    if (kAvx2) return squared_error_avx2(image, a, b, c);
#endif
    return squared_error_of(image, a, b, c);
}

FaceSums face_sums(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c) {
#if defined(__x86_64__)
    if (kAvx2) return face_sums_avx2(image, a, b, c);
#endif
    return face_sums_of(image, a, b, c);
}

WorstPixel worst_pixel(const ImagePlanes& image, const Corner& a, const Corner& b, const Corner& c) {
    const Plane plane(a, b, c);
    WorstPixel worst;
    for_each_chunk(
        image, plane, a, b, c,
        [&](const Float8* e, const Float8&, float, const Int8& inside, int y, int x) {
            const Float8 ee = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
            for (int k = 0; k < 8; ++k)
                if (inside[k] && ee[k] > worst.error) worst = {x + k, y, ee[k]};
        },
        [] {});
    return worst;
}

}  // namespace imgmesh
