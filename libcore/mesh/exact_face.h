// Faces in whole numbers: which of them holds a point, and its weights there, without any rounding but the
// last.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libcore/base/simd.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// A position in units of kPositionStep.
struct GridPoint {
    std::int32_t x = 0, y = 0;
};

/// Units in a pixel.
inline constexpr int kPixelUnits = static_cast<int>(1 / kPositionStep);

/// The binary logarithm of the number of steps in a weight of 1 (weight_grid.h).
inline int weight_bits(WeightPrecision precision) {
    return precision == WeightPrecision::kHalf ? 11 : 24;
}

/// Twice the areas of the triangles of a point and each side of a face [units^2], by the opposite corner.
/// Their sum is twice the area of the face.
struct SideAreas {
    std::int64_t a, b, c;

    bool hold() const { return (a | b | c) >= 0; }
    bool hold_strictly() const { return ((a - 1) | (b - 1) | (c - 1)) >= 0; }
};

/// A face (a, b, c) of positive area. It takes 64 bytes, one cache line. Coordinates are below 2^23 in
/// magnitude, so areas are below 2^48.
struct alignas(64) ExactFace {
    GridPoint a;
    std::int32_t bx, by, cx, cy;  ///< gradients of the areas opposite b and c
    std::int64_t area = 0;  ///< twice the area [units^2]; 0 for a face without area or of clockwise corners
    double inverse_area;
    std::int64_t order;  ///< by the sum of the corners' y, then x
    std::array<std::uint8_t, 3>
        precedence;  ///< of the corners: 2 for the one of lowest y, then x; 0 for the last

    IMGMESH_INLINE SideAreas at(GridPoint p) const {
        const std::int64_t dx = p.x - a.x, dy = p.y - a.y;
        const std::int64_t b = bx * dx + by * dy, c = cx * dx + cy * dy;
        return {area - b - c, b, c};
    }

    /// Returns the weights of a point of the face, as coordinates in the face `id`: multiples of 2^-bits that
    /// sum to one, by largest remainders. Of equal remainders those of higher precedence come first.
    IMGMESH_INLINE PixelCoord weights(Id id, const SideAreas& areas, int bits) const {
        // The quotient of doubles is off by less than one; products may overflow, their difference does not.
        const auto quotient = [&](std::int64_t side, std::int64_t& rest) {
            const auto whole = static_cast<std::uint64_t>(side) << bits;
            auto q = static_cast<std::int64_t>(static_cast<double>(side) * inverse_area *
                                               static_cast<double>(std::int64_t{1} << bits));
            rest = static_cast<std::int64_t>(whole - static_cast<std::uint64_t>(q) *
                                                         static_cast<std::uint64_t>(area));
            const std::int64_t low = rest < 0, high = rest >= area;
            q += high - low;
            rest += (low - high) * area;
            return q;
        };
        std::int64_t rest_b, rest_c;
        std::int64_t b = quotient(areas.b, rest_b), c = quotient(areas.c, rest_c);
        // The three remainders sum to `left` areas.
        const std::int64_t both = rest_b + rest_c, left = (both > 0) + (both > area);
        const std::int64_t rank_a = (left * area - both) * 4 + precedence[0],
                           rank_b = rest_b * 4 + precedence[1], rank_c = rest_c * 4 + precedence[2];
        b += (rank_a > rank_b) + (rank_c > rank_b) < left;
        c += (rank_a > rank_c) + (rank_b > rank_c) < left;
        const float step = 1 / static_cast<float>(1 << bits);
        return {id, static_cast<float>(b) * step, static_cast<float>(c) * step};
    }
};

/// Returns one ExactFace for each face. Throws Error(kUnsupported) for a vertex whose position is not a
/// multiple of kPositionStep below 131072 pixels in magnitude.
std::vector<ExactFace> exact_faces(const BaseMesh& mesh);

}  // namespace imgmesh
