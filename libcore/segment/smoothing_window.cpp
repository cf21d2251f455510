#include "libcore/segment/smoothing_window.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "libcore/base/parallel.h"
#include "libcore/base/simd.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 8, kLanes = 8;
static_assert(kLanes <= PaddedPlanes::kMargin);

// exp(-t) as (1 - t/8)^8: without the library's exponential, and exactly 0 from 8 on.
constexpr float kEnd = 8;

// The least variance of positions [pixels^2]. Where fewer pixels have a weight the slope is 0; where more
// have, it is exact to a thousandth.
constexpr float kLeastVariance = 1e-3f;

struct Neighbor {
    std::ptrdiff_t offset;
    float dx, dy, weight;
};

std::vector<Neighbor> neighbors(std::size_t stride, double spatial) {
    const int radius = static_cast<int>(2 * spatial);
    assert(radius <= PaddedPlanes::kMargin);
    std::vector<Neighbor> all;
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx) {
            const int square = dx * dx + dy * dy;
            if (square == 0 || square > radius * radius) continue;
            all.push_back({dy * static_cast<std::ptrdiff_t>(stride) + dx, float(dx), float(dy),
                           float(std::exp(-square / (2 * spatial * spatial)))});
        }
    return all;
}

// Weighted sums over a window: of 1, of x, y, xx, xy, yy, and for each value of it and its products with x
// and y.
struct Sums {
    Float8 one, x, y, xx, xy, yy;
    Float8 value[3], value_x[3], value_y[3];
};

struct Window {
    const SmoothingScene& scene;
    const PaddedPlanes& guide;
    const std::vector<Neighbor>& around;
    float per_square, per_height;  // t for one square of the guide's difference, and of the height

    // Returns whether some of the places are not these.
    static IMGMESH_INLINE bool differ(const Int8& here, const std::int32_t* there) {
        Int8 other;
        std::memcpy(&other, there, sizeof other);
        other = here != other;
        std::int64_t any[4];
        std::memcpy(any, &other, sizeof any);
        return (any[0] | any[1] | any[2] | any[3]) != 0;
    }

    // Adds what the heights between these pixels' cells and their neighbours' make of t. Pixels side by side
    // mostly lie in the same two cells.
    IMGMESH_INLINE Float8 with_heights(const Float8& t, const std::int32_t* here,
                                       const std::int32_t* there) const {
        alignas(Float8) float sum[kLanes];
        std::memcpy(sum, &t, sizeof sum);
        std::int32_t a = -1, b = -1;
        float more = 0;
        for (int k = 0; k < kLanes; ++k) {
            if (here[k] == there[k] || here[k] < 0 || there[k] < 0 || !(sum[k] < kEnd)) continue;
            if (here[k] != a || there[k] != b) {
                a = here[k];
                b = there[k];
                const float h = scene.heights.between(static_cast<Id>(a), static_cast<Id>(b)) * per_height;
                more = std::min(h * h, kEnd);
            }
            sum[k] += more;
        }
        return load8(sum);
    }

    template <bool kStraight>
    IMGMESH_INLINE void add(std::size_t i, Sums& sums) const {
        const std::int32_t* places = scene.places.data();
        const float* share = scene.values.plane(3);
        Float8 own[3];
        sums.one = load8(share + i);
        for (int c = 0; c < 3; ++c) {
            own[c] = load8(guide.plane(c) + i);
            sums.value[c] = sums.one * load8(scene.values.plane(c) + i);
        }
        Int8 here;
        std::memcpy(&here, places + i, sizeof here);
        for (const Neighbor& n : around) {
            const std::size_t j = i + static_cast<std::size_t>(n.offset);
            Float8 t{};
            for (int c = 0; c < 3; ++c) {
                const Float8 d = load8(guide.plane(c) + j) - own[c];
                t += d * d;
            }
            t *= per_square;
            if (per_height > 0 && differ(here, places + j)) t = with_heights(t, places + i, places + j);
            Float8 w = 1 - t * (1 / kEnd);
            w = w > 0 ? w : Float8{};
            w *= w;
            w *= w;
            w *= w;
            w *= load8(share + j) * n.weight;
            sums.one += w;
            const Float8 wx = w * n.dx, wy = w * n.dy;
            if constexpr (kStraight) {
                sums.x += wx;
                sums.y += wy;
                sums.xx += wx * n.dx;
                sums.xy += wx * n.dy;
                sums.yy += wy * n.dy;
            }
            for (int c = 0; c < 3; ++c) {
                const Float8 value = load8(scene.values.plane(c) + j);
                sums.value[c] += w * value;
                if constexpr (kStraight) {
                    sums.value_x[c] += wx * value;
                    sums.value_y[c] += wy * value;
                }
            }
        }
    }

    template <bool kStraight>
    IMGMESH_INLINE void smooth_row(int y, PaddedPlanes& out) const {
        for (int x = 0; x < scene.size.width; x += kLanes) {
            const std::size_t i = out.index(x, y);
            Sums s{};
            add<kStraight>(i, s);
            // Without share there is no sum; what is computed then is not taken.
            const Float8 inside = load8(scene.values.plane(3) + i);
            const Float8 per = 1 / (inside > 0 ? s.one : Float8{} + 1);
            Float8 mx{}, my{}, xx{}, xy{}, yy{}, per_determinant{};
            if constexpr (kStraight) {
                mx = s.x * per;
                my = s.y * per;
                xx = s.xx * per - mx * mx + kLeastVariance;
                xy = s.xy * per - mx * my;
                yy = s.yy * per - my * my + kLeastVariance;
                per_determinant = 1 / (xx * yy - xy * xy);
            }
            for (int c = 0; c < 3; ++c) {
                Float8 result = s.value[c] * per;
                if constexpr (kStraight) {
                    const Float8 cx = s.value_x[c] * per - result * mx, cy = s.value_y[c] * per - result * my;
                    result -= ((cx * yy - cy * xy) * mx + (cy * xx - cx * xy) * my) * per_determinant;
                }
                result = inside > 0 ? result : load8(scene.values.plane(c) + i);
                const auto count = static_cast<std::size_t>(std::min(kLanes, scene.size.width - x));
                std::memcpy(out.plane(c) + i, &result, count * sizeof(float));
            }
        }
    }

    template <bool kStraight>
    void smooth_rows(int first, int last, PaddedPlanes& out) const {
        for (int y = first; y < last; ++y) smooth_row<kStraight>(y, out);
    }
    template <bool kStraight>
    __attribute__((target("avx2"))) void smooth_rows_avx2(int first, int last, PaddedPlanes& out) const {
        for (int y = first; y < last; ++y) smooth_row<kStraight>(y, out);
    }
};

}  // namespace

PaddedPlanes smooth_planes(const SmoothingScene& scene, const PaddedPlanes& guide,
                           const SmoothingWeights& weights, bool straight) {
    PaddedPlanes out(scene.size, 3);
    const std::vector<Neighbor> around = neighbors(out.stride(), weights.spatial);
    const Window window{scene, guide, around, static_cast<float>(1 / (weights.range * weights.range)),
                        static_cast<float>(1 / weights.height)};
    const bool wide = has_avx2();
    parallel_blocks(0, scene.size.height, kGrainRows, [&](int first, int last) {
        if (straight)
            wide ? window.smooth_rows_avx2<true>(first, last, out)
                 : window.smooth_rows<true>(first, last, out);
        else
            wide ? window.smooth_rows_avx2<false>(first, last, out)
                 : window.smooth_rows<false>(first, last, out);
    });
    return out;
}

}  // namespace imgmesh
