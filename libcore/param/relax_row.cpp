// The steps of the pixels of a row: side by side while there are as many as lanes.
#include <algorithm>
#include <bit>

#include "libcore/param/relax_lanes.h"
#include "libcore/param/relax_sweep.h"

namespace imgmesh {

// Does what move_pixel() does for (x, y), (x + 2, y), ... none of them on a side or a boundary, with
// three features. T has a lane for each; the first `resting` do not move.
template <typename T>
IMGMESH_INLINE void RelaxSweep::move_lanes(int x, int y, int resting) const {
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

bool RelaxSweep::all_free(std::size_t index, std::size_t lanes) const {
    std::uint8_t all = kFree;
    for (std::size_t lane = 0; lane < lanes; ++lane) all &= pixels.freedom[index + 2 * lane];
    return all != 0;
}

// Moves pixels side by side while there are as many, from column x on. Returns the first column left.
template <typename T>
IMGMESH_INLINE int RelaxSweep::move_in_lanes(int x, int y) const {
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
IMGMESH_INLINE void RelaxSweep::move_row(int y, int parity) const {
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

namespace {

void move_row_portably(const RelaxSweep& sweep, int y, int parity) {
    sweep.move_row<Float8>(y, parity);
}
#if defined(__x86_64__)
__attribute__((target("avx2"))) void move_row_avx2(const RelaxSweep& sweep, int y, int parity) {
    sweep.move_row<Float8>(y, parity);
}
IMGMESH_AVX512 void move_row_avx512(const RelaxSweep& sweep, int y, int parity) {
    sweep.move_row<Float16>(y, parity);
}
#endif

}  // namespace

MoveRow widest_move_row() {
#if defined(__x86_64__)
    if (has_avx512()) return move_row_avx512;
    if (has_avx2()) return move_row_avx2;
#endif
    return move_row_portably;
}

}  // namespace imgmesh
