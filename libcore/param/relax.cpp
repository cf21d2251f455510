// Source: docs/decisions/0002-relaxed-map.md. The paper tracks pixels through every collapse instead (sec.
// 3.3).
//
// A pixel's step is written twice. move_pixel() is the clear form; move_lanes() does the same for pixels side
// by side, bit for bit (a test compares them).
#include "libcore/param/relax.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "libcore/base/parallel.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/base/simd.h"
#include "libcore/mesh/mask_fans.h"
#include "libcore/param/relax_lanes.h"
#include "libcore/param/relax_step.h"

namespace imgmesh {
namespace {

// Where a step would fold the grid, it is first turned aside from the triangle that it folds most, then made
// shorter.
constexpr int kTurns = 3, kHalvings = 2;

// A turned step leaves its triangle so much more than the least area [px^2], as it still has to be rounded to
// the grid.
constexpr float kSpareArea = 0.03f;

// Rows of a block: enough work for the cost of a hand-over, few enough for all threads.
constexpr int kSweptRows = 16;
constexpr int kCopiedRows = 64;

// Rounding to half weights moves a pixel by up to 2/3 of a side / 2048, and changes the areas of triangles of
// usual shape by four times that [px^2 / px]. Above half of the area at rest too little could move.
constexpr float kAreaPerSide = 8.0f / 3 / 2048, kMostLeastArea = 0.5f;

// Displacements up to here [pixels], so that distances between neighbours stay below 2^11 steps: products of
// two of them are then exact in floats, and so is every test of an area. Colours move pixels by a few pixels.
constexpr float kFarthest = 31;

// The eight pixels around one, from the east over the south. Even indices are straight neighbours.
constexpr int kStepX[8] = {1, 1, 0, -1, -1, -1, 0, 1};
constexpr int kStepY[8] = {0, 1, 1, 1, 0, -1, -1, -1};

struct Sweep {
    PixelEmbedding& pixels;
    const BaseMesh& mesh;
    const std::vector<FaceField>& fields;
    const std::vector<Face>& neighbors;
    const FeatureImage& feature;
    const AuxiliaryFields& auxiliary;
    float mu, rate, steps, least, stride;

    // The least area of triangles around a pixel of a face: the larger the face, the more weights of half
    // precision change areas.
    template <typename T>
    IMGMESH_INLINE T least_in(T longest_side) const {
        return clamped(longest_side * kAreaPerSide, least, kMostLeastArea);
    }

    // The nearest displacement on the grid.
    template <typename T>
    IMGMESH_INLINE T on_grid(T displacement) const {
        return clamped(rounded(displacement * steps) / steps, -kFarthest, kFarthest);
    }

    // Whether a step inside a face is worth taking. With a rate that has been decided already.
    template <typename T>
    IMGMESH_INLINE auto is_better(const NewtonStep<T>& step, T sx, T sy) const {
        return step.change(sx, sy) < T{} + (rate > 0 ? std::numeric_limits<float>::max() : 0);
    }

    void move_pixel(int x, int y) const {
        const std::size_t index = pixels.index(x, y);
        if (pixels.outside(index)) return;
        const Around around(pixels, x, y);
        const float rest_x = static_cast<float>(x), rest_y = static_cast<float>(y);
        const float own_x = pixels.dx[index], own_y = pixels.dy[index];
        const float px = rest_x + own_x, py = rest_y + own_y;
        float sx, sy;
        const FaceField& field = fields[pixels.face[index]];
        const float* color = feature.pixel(index);
        NewtonStep<float> step(px, py, rest_x + around.mean_x, rest_y + around.mean_y, mu);
        const float from_ax = px - field.ax, from_ay = py - field.ay;
        step.add_features(field.f, field.fx, field.fy, color, std::min(3, feature.channels), from_ax,
                          from_ay);
        const float* f = auxiliary.of(pixels.face[index]);
        for (std::size_t c = 0; c < auxiliary.features; ++c, f += 3)
            step.add_features(f, f + 1, f + 2, color + 3 + c, 1, from_ax, from_ay);
        step.solve(stride, sx, sy);
        if (rate > 0 && pixels.is_free(x, y)) make_cheap(step, own_x, own_y, around.dx, around.dy, sx, sy);
        const bool pinned_x = pixels.pinned_x(x, y), pinned_y = pixels.pinned_y(x, y);
        if (pinned_x) sx = 0;
        if (pinned_y) sy = 0;
        const float least_here = least_in(field.longest);
        for (int tries = 0; tries <= kTurns + kHalvings; ++tries) {
            const float qx = on_image(rest_x + on_grid(own_x + sx), pixels.width);
            const float qy = on_image(rest_y + on_grid(own_y + sy), pixels.height);
            if (least_area(qx, qy, around.x, around.y) >= least_here) {
                if (beyond(field, qx, qy))
                    cross(x, y, qx, qy);
                else if (is_better(step, qx - px, qy - py))
                    place(index, qx - rest_x, qy - rest_y, pixels.face[index]);
                return;
            }
            float to_x = px + sx, to_y = py + sy;
            widen_least(to_x, to_y, around.x, around.y, least_here + kSpareArea);
            const bool turn = tries < kTurns;
            sx = pinned_x ? 0 : turn ? to_x - px : sx * 0.5f;
            sy = pinned_y ? 0 : turn ? to_y - py : sy * 0.5f;
        }
    }

    // The neighbours of a pixel: their displacements, their places, and the mean displacement of the straight
    // ones. Pixels that do not exist, or are outside, are NaN, which is never the lesser.
    struct Around {
        float dx[8], dy[8], x[8], y[8], mean_x = 0, mean_y = 0;

        Around(const PixelEmbedding& pixels, int px, int py) {
            float count = 0;
            for (int k = 0; k < 8; ++k) {
                const int i = px + kStepX[k], j = py + kStepY[k];
                const bool inside = pixels.contains(i, j);
                dx[k] = inside ? pixels.dx[pixels.index(i, j)] : std::numeric_limits<float>::quiet_NaN();
                dy[k] = inside ? pixels.dy[pixels.index(i, j)] : std::numeric_limits<float>::quiet_NaN();
                x[k] = static_cast<float>(i) + dx[k];
                y[k] = static_cast<float>(j) + dy[k];
                if (k % 2 != 0 || std::isnan(dx[k])) continue;
                mean_x += dx[k];
                mean_y += dy[k];
                ++count;
            }
            mean_x /= count;
            mean_y /= count;
        }
    };

    template <typename T>
    static IMGMESH_INLINE T on_image(T position, int side) {
        return clamped(position, 0, static_cast<float>(side - 1));
    }

    // Whether a place is on the far side of one of the face's edges.
    static bool beyond(const FaceField& field, float x, float y) {
        const float u = field.u(x, y), v = field.v(x, y);
        return lesser(lesser(u, v), 1 - u - v) < 0;
    }

    // Moves a pixel to a place in another face if it is better off there, else half as far if that is better.
    void cross(int x, int y, float qx, float qy) const {
        const std::size_t index = pixels.index(x, y);
        const Around around(pixels, x, y);
        const float rest_x = static_cast<float>(x), rest_y = static_cast<float>(y);
        const float own_x = pixels.dx[index], own_y = pixels.dy[index];
        const Id own = pixels.face[index];
        const float now = energy(index, own, rest_x + own_x, rest_y + own_y, rest_x + around.mean_x,
                                 rest_y + around.mean_y);
        for (const bool half : {false, true}) {
            if (half) {
                qx = on_image(rest_x + on_grid(own_x + (qx - rest_x - own_x) * 0.5f), pixels.width);
                qy = on_image(rest_y + on_grid(own_y + (qy - rest_y - own_y) * 0.5f), pixels.height);
                if (!(least_area(qx, qy, around.x, around.y) >= least_in(fields[own].longest))) return;
            }
            const Id face = locate_face({qx, qy}, own, fields, neighbors);
            if (rate <= 0 &&
                !(energy(index, face, qx, qy, rest_x + around.mean_x, rest_y + around.mean_y) < now))
                continue;
            if (may_lie_in(face, {qx, qy})) place(index, qx - rest_x, qy - rest_y, face);
            return;
        }
    }

    // What it costs a pixel to be at a place of a face, if its neighbours would have it at (tx, ty).
    float energy(std::size_t index, Id face, float px, float py, float tx, float ty) const {
        const FaceField& field = fields[face];
        const float* color = feature.pixel(index);
        const float dx = px - field.ax, dy = py - field.ay;
        float sum = mu * ((px - tx) * (px - tx) + (py - ty) * (py - ty));
        const auto add = [&](float f, float fx, float fy, float wanted) {
            const float e = f + fx * dx + fy * dy - wanted;
            sum += e * e;
        };
        for (int c = 0; c < std::min(3, feature.channels); ++c)
            add(field.f[c], field.fx[c], field.fy[c], color[c]);
        const float* f = auxiliary.of(face);
        for (std::size_t c = 0; c < auxiliary.features; ++c, f += 3) add(f[0], f[1], f[2], color[3 + c]);
        return sum;
    }

    // Changes the step (sx, sy) to the best place into one to the cheapest.
    template <typename T>
    IMGMESH_INLINE void make_cheap(const NewtonStep<T>& step, T own_x, T own_y, const T* ndx, const T* ndy,
                                   T& sx, T& sy) const {
        T x = (own_x + sx) * steps, y = (own_y + sy) * steps;
        take_cheapest(step, AroundPixel<T>(own_x, ndx, steps), AroundPixel<T>(own_y, ndy, steps), steps, rate,
                      x, y);
        sx = x / steps - own_x;
        sy = y / steps - own_y;
    }

    void place(std::size_t index, float dx, float dy, Id face) const {
        pixels.dx[index] = dx;
        pixels.dy[index] = dy;
        pixels.face[index] = face;
    }

    // Whether locating p ended there and not at a boundary in between. A rectangle has none between.
    bool may_lie_in(Id face, const Vec2f& p) const {
        if (pixels.freedom.empty()) return true;
        const Vec2f &a = mesh.position[mesh.faces[face][0]], &b = mesh.position[mesh.faces[face][1]],
                    &c = mesh.position[mesh.faces[face][2]];
        return std::min({signed_area2(a, b, p), signed_area2(b, c, p), signed_area2(c, a, p)}) >= 0;
    }

    // Does what move_pixel() does for (x, y), (x + 2, y), ... none of them on a side or a boundary, with
    // three features. T has a lane for each; the first `resting` do not move.
    template <typename T>
    IMGMESH_INLINE void move_lanes(int x, int y, int resting) const {
        const std::size_t index = pixels.index(x, y);
        const LaneFields<T> field(fields.data(), &pixels.face[index]);
        T color[3];
        gather3(feature.pixel(index), 6, color);
        const T rest_x = static_cast<float>(x) + every_other<T>();
        const float rest_y = static_cast<float>(y);
        T ndx[8], ndy[8], nx[8], ny[8], mean_x = {}, mean_y = {};
        for (int k = 0; k < 8; ++k) {
            const std::size_t n = pixels.index(x + kStepX[k], y + kStepY[k]);
            const T dx = ndx[k] = load_every_other<T>(&pixels.dx[n]);
            const T dy = ndy[k] = load_every_other<T>(&pixels.dy[n]);
            nx[k] = rest_x + static_cast<float>(kStepX[k]) + dx;
            ny[k] = static_cast<float>(y + kStepY[k]) + dy;
            if (k % 2 != 0) continue;
            mean_x += dx;
            mean_y += dy;
        }
        const T own_x = load_every_other<T>(&pixels.dx[index]), px = rest_x + own_x;
        const T own_y = load_every_other<T>(&pixels.dy[index]), py = rest_y + own_y;
        T sx, sy;
        NewtonStep<T> step(px, py, rest_x + mean_x / 4, rest_y + mean_y / 4, mu);
        step.add_features(field.f, field.fx, field.fy, color, 3, px - field.ax, py - field.ay);
        step.solve(stride, sx, sy);
        if (rate > 0) make_cheap(step, own_x, own_y, ndx, ndy, sx, sy);
        const T least_here = least_in(field.longest);
        T to_x = px, to_y = py;
        constexpr unsigned kAll = (1u << kLaneCount<T>)-1;
        const LaneMask<T> rests = every_other<T>() < T{} + static_cast<float>(2 * resting);
        LaneMask<T> found = rests;
        for (int tries = 0;; ++tries) {
            const T qx = on_image(rest_x + on_grid(own_x + sx), pixels.width),
                    qy = on_image(rest_y + on_grid(own_y + sy), pixels.height);
            const LaneMask<T> take = (least_area(qx, qy, nx, ny) >= least_here) & ~found;
            to_x = take ? qx : to_x;
            to_y = take ? qy : to_y;
            found |= take;
            if (tries == kTurns + kHalvings || bits_of(found) == kAll) break;
            if (tries < kTurns) {
                T turned_x = px + sx, turned_y = py + sy;
                widen_least(turned_x, turned_y, nx, ny, least_here + kSpareArea);
                sx = turned_x - px;
                sy = turned_y - py;
            } else {
                sx *= 0.5f;
                sy *= 0.5f;
            }
        }
        const T ex = to_x - field.ax, ey = to_y - field.ay;
        const T u = field.ux * ex + field.uy * ey, v = field.vx * ex + field.vy * ey;
        const LaneMask<T> crosses = (lesser(lesser(u, v), 1 - u - v) < T{}) & found & ~rests;
        const LaneMask<T> stays = is_better(step, to_x - px, to_y - py) & ~crosses;
        store_every_other(&pixels.dx[index], stays ? to_x - rest_x : own_x);
        store_every_other(&pixels.dy[index], stays ? to_y - rest_y : own_y);
        for (unsigned left = bits_of(crosses); left != 0; left &= left - 1) {
            const int l = std::countr_zero(left);
            cross(x + 2 * l, y, to_x[l], to_y[l]);
        }
    }

    bool all_free(std::size_t index, std::size_t lanes) const {
        std::uint8_t all = kFree;
        for (std::size_t lane = 0; lane < lanes; ++lane) all &= pixels.freedom[index + 2 * lane];
        return all != 0;
    }

    // Moves pixels side by side while there are as many, from column x on. Returns the first column left.
    template <typename T>
    IMGMESH_INLINE int move_in_lanes(int x, int y) const {
        constexpr int kColumns = 2 * kLaneCount<T>;
        // The last lanes that there is room for: they read up to their first column + kColumns.
        const int last = pixels.width - 1 - kColumns - (pixels.width - 1 - x) % 2;
        if (last < x) return x;
        for (;; x += kColumns) {
            const int resting = std::max(0, x - last) / 2;
            const int begin = std::min(x, last);
            if (pixels.freedom.empty() || all_free(pixels.index(begin, y), kLaneCount<T>))
                move_lanes<T>(begin, y, resting);
            else
                for (int lane = 2 * resting; lane < kColumns; lane += 2) move_pixel(begin + lane, y);
            if (x >= last) return last + kColumns;
        }
    }

    template <typename T>
    IMGMESH_INLINE void move_row(int y, int parity) const {
        int x = parity;
        if (feature.channels == 3 && y > 0 && y < pixels.height - 1) {
            if (x == 0) {
                move_pixel(0, y);
                x = 2;
            }
            x = move_in_lanes<T>(x, y);
        }
        for (; x < pixels.width; x += 2) move_pixel(x, y);
    }
    void move_row_portably(int y, int parity) const { move_row<Float8>(y, parity); }
#if defined(__x86_64__)
    __attribute__((target("avx2"))) void move_row_avx2(int y, int parity) const {
        move_row<Float8>(y, parity);
    }
    IMGMESH_AVX512 void move_row_avx512(int y, int parity) const {
        move_row<Float16>(y, parity);
    }
#endif
};

std::uint8_t freedom_of(const Mask& mask, int x, int y) {
    // The places where a boundary begins and ends at a pixel do not depend on diagonals.
    const PixelFans fans = fans_at(mask, x, y, [](int) { return false; });
    if (fans.count != 1) return kPinnedX | kPinnedY;
    const Fan& fan = fans.fan[0];
    if (!fan.closed) {
        const int from = fan.direction[0], to = fan.direction[fan.count - 1];
        if (std::abs(from - to) != 4 || from % 2 != 0) return kPinnedX | kPinnedY;
        return from % 4 == 0 ? kPinnedY : kPinnedX;
    }
    return kFree;
}

}  // namespace

PixelEmbedding resting_pixels(const PixelMap& trivial, const Mask& mask) {
    PixelEmbedding pixels{trivial, parallel_vector<float>(trivial.size()),
                          parallel_vector<float>(trivial.size()), parallel_vector<Id>(trivial.size())};
    parallel_blocks(0, trivial.height, kCopiedRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < trivial.width; ++x) pixels.face[pixels.index(x, y)] = trivial.at(x, y).face;
    });
    if (mask.empty()) return pixels;
    pixels.freedom.reserve(trivial.size());
    for (int y = 0; y < trivial.height; ++y)
        for (int x = 0; x < trivial.width; ++x) pixels.freedom.push_back(freedom_of(mask, x, y));
    for (std::size_t i = 0; i < pixels.face.size(); ++i)
        if (pixels.outside(i)) pixels.dx[i] = pixels.dy[i] = std::numeric_limits<float>::quiet_NaN();
    return pixels;
}

Displacements displacements(const PixelEmbedding& pixels, int steps) {
    Displacements out{pixels,
                      steps,
                      parallel_vector<std::int16_t>(pixels.pixel_count()),
                      parallel_vector<std::int16_t>(pixels.pixel_count()),
                      {}};
    if (!pixels.freedom.empty()) out.inside = Mask(pixels);
    const auto scale = static_cast<float>(steps);
    parallel_blocks(0, pixels.height, kCopiedRows, [&](int first, int last) {
        for (std::size_t i = pixels.row_begin(first); i < as_index(last) * as_index(pixels.width); ++i) {
            if (pixels.outside(i)) continue;
            if (!out.inside.empty()) out.inside[i] = 1;
            out.dx[i] = static_cast<std::int16_t>(pixels.dx[i] * scale);
            out.dy[i] = static_cast<std::int16_t>(pixels.dy[i] * scale);
        }
    });
    return out;
}

void relax(PixelEmbedding& pixels, const BaseMesh& mesh, const std::vector<FaceField>& fields,
           const std::vector<Face>& neighbors, const FeatureImage& feature, const RelaxParams& params) {
    const AuxiliaryFields auxiliary = auxiliary_fields(mesh, fields);
    assert(as_int(auxiliary.features) == std::max(0, feature.channels - 3));
    const Sweep sweep{pixels,
                      mesh,
                      fields,
                      neighbors,
                      feature,
                      auxiliary,
                      params.smoothness,
                      params.rate,
                      static_cast<float>(params.steps),
                      least_moving_area(params.steps),
                      params.stride};
    auto move_row = &Sweep::move_row_portably;
#if defined(__x86_64__)
    if (has_avx2()) move_row = &Sweep::move_row_avx2;
    if (has_avx512()) move_row = &Sweep::move_row_avx512;
#endif
    const int h = pixels.height;
    for (int n = 0; n < params.sweeps; ++n)
        for (int parity = 0; parity < 4; ++parity)
            parallel_blocks(0, (h + 1) / 2, kSweptRows, [&](int first, int last) {
                for (int row = first; row < last; ++row)
                    if (const int y = 2 * row + parity / 2; y < h) (sweep.*move_row)(y, parity % 2);
            });
}

}  // namespace imgmesh
