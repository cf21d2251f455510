// Values of eight or sixteen places in memory, side by side.
#pragma once

#include <cstddef>

#include "libcore/base/simd.h"

namespace imgmesh {

/// Transposes: rows[i][j] <-> rows[j][i].
IMGMESH_INLINE void transpose8(Float8 (&rows)[8]) {
    Float8 a[8], b[8];
    for (int i = 0; i < 8; i += 2) {
        a[i] = __builtin_shufflevector(rows[i], rows[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
        a[i + 1] = __builtin_shufflevector(rows[i], rows[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
    }
    for (int i = 0; i < 8; i += 4)
        for (int k = 0; k < 2; ++k) {
            b[i + 2 * k] = __builtin_shufflevector(a[i + k], a[i + k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
            b[i + 2 * k + 1] = __builtin_shufflevector(a[i + k], a[i + k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
        }
    for (int i = 0; i < 4; ++i) {
        rows[i] = __builtin_shufflevector(b[i], b[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
        rows[i + 4] = __builtin_shufflevector(b[i], b[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

// Of two vectors the lower halves, the upper halves, and the first and third or second and fourth quarters.
IMGMESH_INLINE Float16 low_halves(Float16 p, Float16 q) {
    return __builtin_shufflevector(p, q, 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23);
}
IMGMESH_INLINE Float16 high_halves(Float16 p, Float16 q) {
    return __builtin_shufflevector(p, q, 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
}
IMGMESH_INLINE Float16 even_quarters(Float16 p, Float16 q) {
    return __builtin_shufflevector(p, q, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27);
}
IMGMESH_INLINE Float16 odd_quarters(Float16 p, Float16 q) {
    return __builtin_shufflevector(p, q, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
}
/// The same for sixteen.
IMGMESH_INLINE void transpose16(Float16 (&rows)[16]) {
    // Inside blocks of 4 x 4 first: b[i + m] has columns m, 4 + m, 8 + m and 12 + m of the rows i to i + 3.
    Float16 a[16], b[16];
    for (int i = 0; i < 16; i += 2) {
        a[i] = __builtin_shufflevector(rows[i], rows[i + 1], 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28,
                                       13, 29);
        a[i + 1] = __builtin_shufflevector(rows[i], rows[i + 1], 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27,
                                           14, 30, 15, 31);
    }
    for (int i = 0; i < 16; i += 4)
        for (int k = 0; k < 2; ++k) {
            b[i + 2 * k] = __builtin_shufflevector(a[i + k], a[i + k + 2], 0, 1, 16, 17, 4, 5, 20, 21, 8, 9,
                                                   24, 25, 12, 13, 28, 29);
            b[i + 2 * k + 1] = __builtin_shufflevector(a[i + k], a[i + k + 2], 2, 3, 18, 19, 6, 7, 22, 23, 10,
                                                       11, 26, 27, 14, 15, 30, 31);
        }
    for (int m = 0; m < 4; ++m) {
        const Float16 top = low_halves(b[m], b[4 + m]), bottom = low_halves(b[8 + m], b[12 + m]),
                      top2 = high_halves(b[m], b[4 + m]), bottom2 = high_halves(b[8 + m], b[12 + m]);
        rows[m] = even_quarters(top, bottom);
        rows[4 + m] = odd_quarters(top, bottom);
        rows[8 + m] = even_quarters(top2, bottom2);
        rows[12 + m] = odd_quarters(top2, bottom2);
    }
}

IMGMESH_INLINE Float4 load4(const float* p) {
    Float4 v;
    std::memcpy(&v, p, sizeof v);
    return v;
}

/// Sets out[c][l] to p[l * step + c]. Reads one float more for each l.
IMGMESH_INLINE void gather3(const float* p, std::size_t step, Float8 (&out)[3]) {
    Float8 r[4];
    for (std::size_t j = 0; j < 4; ++j)
        r[j] =
            __builtin_shufflevector(load4(p + j * step), load4(p + (j + 4) * step), 0, 1, 2, 3, 4, 5, 6, 7);
    const Float8 a = __builtin_shufflevector(r[0], r[1], 0, 8, 1, 9, 4, 12, 5, 13),
                 b = __builtin_shufflevector(r[2], r[3], 0, 8, 1, 9, 4, 12, 5, 13),
                 c = __builtin_shufflevector(r[0], r[1], 2, 10, 3, 11, 6, 14, 7, 15),
                 d = __builtin_shufflevector(r[2], r[3], 2, 10, 3, 11, 6, 14, 7, 15);
    out[0] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
    out[1] = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    out[2] = __builtin_shufflevector(c, d, 0, 1, 8, 9, 4, 5, 12, 13);
}
IMGMESH_INLINE void gather3(const float* p, std::size_t step, Float16 (&out)[3]) {
    Float8 front[3], back[3];
    gather3(p, step, front);
    gather3(p + 8 * step, step, back);
    for (int c = 0; c < 3; ++c)
        out[c] =
            __builtin_shufflevector(front[c], back[c], 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

}  // namespace imgmesh
