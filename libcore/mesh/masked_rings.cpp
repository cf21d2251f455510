#include "libcore/mesh/masked_rings.h"

#include <algorithm>
#include <initializer_list>
#include <numeric>
#include <vector>

#include "libcore/base/parallel.h"
#include "libcore/mesh/mask_fans.h"

namespace imgmesh {
namespace {

constexpr std::uint8_t kCorner = kFixedX | kFixedY;

class MaskedRings {
  public:
    explicit MaskedRings(const GridMesh& grid) : grid_(grid), width_(grid.feature.width) {}

    PixelRings at(int x, int y) const {
        PixelRings out;
        if (const Strip strip = strip_at(grid_.mask, x, y); strip != Strip::kNoStrip) {
            add_strip(out, strip, x, y);
        } else {
            const PixelFans fans = fans_of(x, y);
            for (int f = 0; f < fans.count; ++f)
                add(out, x, y) = ring(fans.fan[static_cast<std::size_t>(f)], x, y);
        }
        return out;
    }

  private:
    PixelFans fans_of(int x, int y) const {
        return fans_at(grid_.mask, x, y, [&](int q) {
            const PixelStep d = kAround[2 * q + 1];
            return grid_.falling_diagonal(x + (d.dx < 0 ? -1 : 0), y + (d.dy < 0 ? -1 : 0)) == (d.dx == d.dy);
        });
    }

    // Returns the n-th vertex of a pixel.
    Id vertex(int x, int y, int n) const {
        const auto pixel = static_cast<Id>(y * width_ + x);
        if (n == 0) return pixel;
        const auto first = std::lower_bound(grid_.copies.begin(), grid_.copies.end(), pixel);
        return static_cast<Id>(grid_.feature.pixel_count()) +
               static_cast<Id>(first - grid_.copies.begin() + n - 1);
    }

    // Adds the next vertex of the pixel.
    Ring& add(PixelRings& pixel, int x, int y) const {
        pixel.vertex[pixel.count] = vertex(x, y, static_cast<int>(pixel.count));
        return pixel.ring[pixel.count++];
    }

    Ring ring(const Fan& fan, int x, int y) const {
        Ring ring;
        ring.x = static_cast<float>(x);
        ring.y = static_cast<float>(y);
        ring.fixed = fan.closed ? 0 : kCorner;
        for (int k = 0; k < fan.count; ++k) {
            const int d = fan.direction[static_cast<std::size_t>(k)];
            const int nx = x + kAround[d].dx, ny = y + kAround[d].dy;
            // An edge is in one fan of its other end: its two faces are neighbours there too.
            const PixelFans fans = fans_of(nx, ny);
            int n = 0;
            while (!fans.fan[static_cast<std::size_t>(n)].has((d + 4) % 8)) ++n;
            ring.neighbor[ring.valence++] = vertex(nx, ny, n);
        }
        return ring;
    }

    // The first vertex of a strip's pixel is on its upper (left) side, the second on its lower (right) side.
    // Cells are split from top left to bottom right.
    void add_strip(PixelRings& out, Strip strip, int x, int y) const {
        if (strip == Strip::kAlone) {
            const Id tl = vertex(x, y, 0), tr = vertex(x, y, 1), bl = vertex(x, y, 2), br = vertex(x, y, 3);
            set(add(out, x, y), x, y, -0.5f, -0.5f, {bl, br, tr});
            set(add(out, x, y), x, y, 0.5f, -0.5f, {tl, br});
            set(add(out, x, y), x, y, -0.5f, 0.5f, {br, tl});
            set(add(out, x, y), x, y, 0.5f, 0.5f, {tr, tl, bl});
            return;
        }
        const int dx = strip == Strip::kAlongX ? 1 : 0, dy = 1 - dx;
        const bool before = strip_at(grid_.mask, x - dx, y - dy) == strip,
                   after = strip_at(grid_.mask, x + dx, y + dy) == strip;
        const auto side = [&](int step, int n) { return vertex(x + step * dx, y + step * dy, n); };
        Ring &first = add(out, x, y), &second = add(out, x, y);
        set(first, x, y, -0.5f * static_cast<float>(dy), -0.5f * static_cast<float>(dx), {});
        set(second, x, y, 0.5f * static_cast<float>(dy), 0.5f * static_cast<float>(dx), {});
        // Along a row the upper side comes first. Along a column everything is mirrored at the falling
        // diagonal, including the sense of turning.
        std::array<Id, 4> upper{}, lower{};
        int up = 0, low = 0;
        if (before) upper[static_cast<std::size_t>(up++)] = side(-1, 0);
        upper[static_cast<std::size_t>(up++)] = side(0, 1);
        if (after) {
            upper[static_cast<std::size_t>(up++)] = side(1, 1);
            upper[static_cast<std::size_t>(up++)] = side(1, 0);
            lower[static_cast<std::size_t>(low++)] = side(1, 1);
        }
        lower[static_cast<std::size_t>(low++)] = side(0, 0);
        if (before) {
            lower[static_cast<std::size_t>(low++)] = side(-1, 0);
            lower[static_cast<std::size_t>(low++)] = side(-1, 1);
        }
        if (strip == Strip::kAlongY) {
            std::reverse(upper.begin(), upper.begin() + up);
            std::reverse(lower.begin(), lower.begin() + low);
        }
        std::copy_n(upper.begin(), up, first.neighbor);
        std::copy_n(lower.begin(), low, second.neighbor);
        first.valence = static_cast<std::uint8_t>(up);
        second.valence = static_cast<std::uint8_t>(low);
    }

    static void set(Ring& ring, int x, int y, float dx, float dy, std::initializer_list<Id> neighbors) {
        ring.x = static_cast<float>(x) + dx;
        ring.y = static_cast<float>(y) + dy;
        ring.fixed = kCorner;
        std::copy(neighbors.begin(), neighbors.end(), ring.neighbor);
        ring.valence = static_cast<std::uint8_t>(neighbors.size());
    }

    const GridMesh& grid_;
    int width_;
};

}  // namespace

PixelRings masked_pixel_rings(const GridMesh& grid, int x, int y) {
    return MaskedRings(grid).at(x, y);
}

Vec2f vertex_place(const GridMesh& grid, Id vertex) {
    const Id pixel = grid.pixel_of(vertex), w = static_cast<Id>(grid.feature.width);
    const int x = static_cast<int>(pixel % w), y = static_cast<int>(pixel / w);
    if (!grid.mask.empty() && strip_at(grid.mask, x, y) != Strip::kNoStrip) {
        const PixelRings rings = masked_pixel_rings(grid, x, y);
        for (std::size_t n = 0; n < rings.count; ++n)
            if (rings.vertex[n] == vertex) return {rings.ring[n].x, rings.ring[n].y};
    }
    return {grid.origin_x + static_cast<float>(x), grid.origin_y + static_cast<float>(y)};
}

std::int64_t masked_face_count(const GridMesh& grid) {
    const Mask& mask = grid.mask;
    std::vector<std::int64_t> rows(static_cast<std::size_t>(mask.height), 0);
    parallel_blocks(0, mask.height, 16, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < mask.width; ++x) {
                std::int64_t& faces = rows[static_cast<std::size_t>(y)];
                const int corners =
                    mask.at(x, y) + mask.at(x + 1, y) + mask.at(x, y + 1) + mask.at(x + 1, y + 1);
                faces += std::max(0, corners - 2);
                const Strip strip = strip_at(mask, x, y);
                if (strip == Strip::kNoStrip) continue;
                const int dx = strip == Strip::kAlongX ? 1 : 0;
                if (strip == Strip::kAlone || strip_at(mask, x + dx, y + 1 - dx) == strip) faces += 2;
            }
    });
    return std::accumulate(rows.begin(), rows.end(), std::int64_t{0});
}

RingMesh masked_rings(const GridMesh& grid) {
    RingMesh rings(grid.vertex_count());
    parallel_blocks(0, grid.feature.height, 16, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < grid.feature.width; ++x) {
                const PixelRings pixel = masked_pixel_rings(grid, x, y);
                for (std::size_t n = 0; n < pixel.count; ++n) rings[pixel.vertex[n]] = pixel.ring[n];
            }
    });
    return rings;
}

}  // namespace imgmesh
