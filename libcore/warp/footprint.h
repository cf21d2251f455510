// The points of the source whose weighted mean a pixel of a drawing is. Internal to warp/.
#pragma once

#include <algorithm>
#include <cmath>

#include "libcore/warp/cell_raster.h"
#include "libcore/warp/displacement.h"

namespace imgmesh {

// How many source pixels one step of an output pixel covers.
inline int taps_of(const Vec2f& step) {
    constexpr float kMostTaps = 64;
    return as_int(std::lround(std::clamp(step.norm(), 1.0f, kMostTaps)));
}
// Whether a single point stands for its pixel: both numbers of taps are 1.
inline bool is_plain(const CellPoint& p) {
    constexpr float kShort = 1.5f * 1.5f;
    return p.dx.squaredNorm() < kShort && p.dy.squaredNorm() < kShort;
}

// Places are rounded, so a share this close to the whole counts as the whole.
inline constexpr float kWhole = 1 - 1.0f / 1024;

// The share of the output pixel around the point that lies inside the image's sides. It is 1 inside of sides
// that do not move across themselves, and exact for sides along the output's axes. `scale` is in output
// pixels per source pixel. It is the distance across the rim, which moves as the pixels beside it do, however
// distorted the cells inside are.
inline float side_coverage(const DisplacementField& field, const Vec2f& scale, const CellPoint& p) {
    constexpr float kStill = 1.0f / CellPlaces::kOne;
    const int nearest[2] = {std::clamp(p.x, 0, field.width - 1), std::clamp(p.y, 0, field.height - 1)};
    float both = 1;
    for (int axis = 0; axis < 2; ++axis) {
        const int side = axis == 0 ? field.width : field.height, cell = axis == 0 ? p.x : p.y;
        const float at = static_cast<float>(cell) + (axis == 0 ? p.fx : p.fy),
                    far = static_cast<float>(side - 1) - at, from_centers = std::min(at, far);
        const int end = at < far ? 0 : side - 1;
        const Vec2f& move =
            field.move[axis == 0 ? field.index(end, nearest[1]) : field.index(nearest[0], end)];
        if (from_centers >= -0.5f && std::abs(move[axis]) < kStill) continue;
        const float across = std::hypot(p.dx[axis], p.dy[axis]);
        if (across <= 0) {
            both *= float(from_centers >= -0.5f);
            continue;
        }
        const float inside =
            from_centers >= 0 ? from_centers / across + 0.5f * scale[axis] : (from_centers + 0.5f) / across;
        both *= std::clamp(0.5f + inside, 0.0f, 1.0f);
    }
    return both > kWhole ? 1.0f : both;
}

inline bool on_rim(const DisplacementField& field, const CellPoint& p) {
    return p.x < 0 || p.y < 0 || p.x + 1 >= field.width || p.y + 1 >= field.height;
}

// Four source pixels and their weights for the point (x + fx, y + fy). The rim shows the pixel beside it.
struct Taps {
    Taps(const DisplacementField& field, int x, int y, float fx, float fy) {
        const int x0 = std::clamp(x, 0, field.width - 1), x1 = std::clamp(x + 1, 0, field.width - 1),
                  y0 = std::clamp(y, 0, field.height - 1), y1 = std::clamp(y + 1, 0, field.height - 1);
        index[0] = field.index(x0, y0);
        index[1] = field.index(x1, y0);
        index[2] = field.index(x0, y1);
        index[3] = field.index(x1, y1);
        weight[0] = (1 - fx) * (1 - fy);
        weight[1] = fx * (1 - fy);
        weight[2] = (1 - fx) * fy;
        weight[3] = fx * fy;
    }
    std::size_t index[4];
    float weight[4];
};

// Calls visit(taps, share) for every point whose mean is the output pixel.
template <typename Visit>
void for_points(const DisplacementField& field, const CellPoint& p, const Visit& visit) {
    if (is_plain(p)) {
        visit(Taps(field, p.x, p.y, p.fx, p.fy), 1.0f);
        return;
    }
    const int n = taps_of(p.dx), m = taps_of(p.dy);
    const float share = 1.0f / static_cast<float>(n * m);
    const Vec2f high(static_cast<float>(field.width), static_cast<float>(field.height));
    for (int j = 0; j < m; ++j)
        for (int i = 0; i < n; ++i) {
            // Relative to the cell, so that coordinates keep their precision in large images.
            const Vec2f at = Vec2f(p.fx, p.fy) +
                             ((static_cast<float>(i) + 0.5f) / static_cast<float>(n) - 0.5f) * p.dx +
                             ((static_cast<float>(j) + 0.5f) / static_cast<float>(m) - 0.5f) * p.dy;
            const float bx = std::floor(std::clamp(at.x(), -high.x() - 1, high.x() + 1)),
                        by = std::floor(std::clamp(at.y(), -high.y() - 1, high.y() + 1));
            visit(Taps(field, p.x + static_cast<int>(bx), p.y + static_cast<int>(by),
                       std::clamp(at.x() - bx, 0.0f, 1.0f), std::clamp(at.y() - by, 0.0f, 1.0f)),
                  share);
        }
}

}  // namespace imgmesh
