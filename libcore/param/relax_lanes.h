// Loads and stores of pixels that move side by side: every other one of a row. Internal to relax_row.cpp.
#pragma once

#include <cstddef>
#include <cstring>

#include "libcore/base/index.h"
#include "libcore/base/simd.h"
#include "libcore/base/transpose.h"
#include "libcore/mesh/face_field.h"

namespace imgmesh {

/// Returns p[0], p[2], p[4], ...; reads the one after the last too.
template <typename T>
IMGMESH_INLINE T load_every_other(const float* p) {
    if constexpr (kLaneCount<T> == 16)
        return load16_every_other(p);
    else
        return load8_every_other(p);
}

IMGMESH_INLINE void store(float* p, Float8 v) {
    std::memcpy(p, &v, sizeof v);
}
/// Sets p[0], p[2], p[4], ...; writes the others up to the one after the last as they are.
IMGMESH_INLINE void store_every_other(float* p, Float8 v) {
    const Float8 front = load8(p), back = load8(p + 8);
    store(p, __builtin_shufflevector(__builtin_shufflevector(v, v, 0, 0, 1, 1, 2, 2, 3, 3), front, 0, 9, 2,
                                     11, 4, 13, 6, 15));
    store(p + 8, __builtin_shufflevector(__builtin_shufflevector(v, v, 4, 4, 5, 5, 6, 6, 7, 7), back, 0, 9, 2,
                                         11, 4, 13, 6, 15));
}
IMGMESH_INLINE void store_every_other(float* p, Float16 v) {
    store_every_other(p, __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7));
    store_every_other(p + 16, __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15));
}

/// 0, 2, 4, ...
template <typename T>
IMGMESH_INLINE T every_other() {
    T v;
    for (int l = 0; l < kLaneCount<T>; ++l) v[l] = static_cast<float>(2 * l);
    return v;
}

/// The FaceFields of pixels side by side.
template <typename T>
struct LaneFields {
    T ax, ay, ux, uy, vx, vy;
    T f[3], fx[3], fy[3];
    T longest;

    /// Reads each as a whole. Lane l is fields[face[2 l]].
    IMGMESH_INLINE LaneFields(const FaceField* fields, const Id* face) {
        static_assert(sizeof(FaceField) == sizeof(Float16) && offsetof(FaceField, ay) == 4 &&
                      offsetof(FaceField, ux) == 8 && offsetof(FaceField, vy) == 20 &&
                      offsetof(FaceField, f) == 24 && offsetof(FaceField, fx) == 36 &&
                      offsetof(FaceField, fy) == 48 && offsetof(FaceField, longest) == 60);
        T row[16];
        if constexpr (kLaneCount<T> == 16) {
            for (std::size_t l = 0; l < 16; ++l) std::memcpy(&row[l], fields + face[2 * l], sizeof row[l]);
            transpose16(row);
        } else {
            Float8 front[8], back[8];
            for (std::size_t l = 0; l < 8; ++l) {
                const auto* bytes = reinterpret_cast<const std::byte*>(fields + face[2 * l]);
                std::memcpy(&front[l], bytes, sizeof front[l]);
                std::memcpy(&back[l], bytes + sizeof front[l], sizeof back[l]);
            }
            transpose8(front);
            transpose8(back);
            for (int k = 0; k < 8; ++k) {
                row[k] = front[k];
                row[8 + k] = back[k];
            }
        }
        ax = row[0], ay = row[1], ux = row[2], uy = row[3], vx = row[4], vy = row[5];
        for (int c = 0; c < 3; ++c) {
            f[c] = row[6 + c];
            fx[c] = row[9 + c];
            fy[c] = row[12 + c];
        }
        longest = row[15];
    }
};

}  // namespace imgmesh
