#include "libcore/collapse/masked_rings.h"

#include <algorithm>
#include <initializer_list>

#include "libcore/base/parallel.h"
#include "libcore/mesh/mask_fans.h"

namespace imgmesh {
namespace {

constexpr std::uint8_t kCorner = kFixedX | kFixedY;

class MaskedRings {
  public:
    explicit MaskedRings(const GridMesh& grid)
        : grid_(grid), width_(grid.feature.width), height_(grid.feature.height) {}

    RingMesh make() const {
        RingMesh rings(grid_.vertex_count());
        parallel_blocks(0, height_, 16, [&](int first, int last) {
            for (int y = first; y < last; ++y)
                for (int x = 0; x < width_; ++x) {
                    if (const Strip strip = strip_at(grid_.mask, x, y); strip != Strip::kNoStrip) {
                        add_strip(rings, strip, x, y);
                        continue;
                    }
                    const PixelFans fans = fans_of(x, y);
                    for (int f = 0; f < fans.count; ++f)
                        rings[vertex(x, y, f)] = ring(fans.fan[static_cast<std::size_t>(f)], x, y);
                }
        });
        return rings;
    }

  private:
    PixelFans fans_of(int x, int y) const {
        return fans_at(grid_.mask, x, y, [&](int q) {
            const PixelStep d = kAround[2 * q + 1];
            return grid_.falling_diagonal(x + (d.dx < 0 ? -1 : 0), y + (d.dy < 0 ? -1 : 0)) == (d.dx == d.dy);
        });
    }

    // The n-th vertex of a pixel.
    Id vertex(int x, int y, int n) const {
        const auto pixel = static_cast<Id>(y * width_ + x);
        if (n == 0) return pixel;
        const auto first = std::lower_bound(grid_.copies.begin(), grid_.copies.end(), pixel);
        return static_cast<Id>(grid_.feature.pixel_count()) +
               static_cast<Id>(first - grid_.copies.begin() + n - 1);
    }

    Ring ring(const Fan& fan, int x, int y) const {
        Ring ring;
        ring.x = static_cast<float>(x);
        ring.y = static_cast<float>(y);
        ring.fixed = fan.closed ? 0 : kCorner;
        for (int k = 0; k < fan.count; ++k) {
            const int d = fan.direction[static_cast<std::size_t>(k)];
            const int nx = x + kAround[d].dx, ny = y + kAround[d].dy;
            // An edge is in one fan of its other end: its two faces are neighbours there as well.
            const PixelFans fans = fans_of(nx, ny);
            int n = 0;
            while (!fans.fan[static_cast<std::size_t>(n)].has((d + 4) % 8)) ++n;
            ring.neighbor[ring.valence++] = vertex(nx, ny, n);
        }
        return ring;
    }

    // A strip's pixels have their first vertex at its upper (left) side and their second at its lower (right)
    // one; cells are split from top left to bottom right.
    void add_strip(RingMesh& rings, Strip strip, int x, int y) const {
        if (strip == Strip::kAlone) {
            const Id tl = vertex(x, y, 0), tr = vertex(x, y, 1), bl = vertex(x, y, 2), br = vertex(x, y, 3);
            set(rings[tl], x, y, -0.5f, -0.5f, {bl, br, tr});
            set(rings[tr], x, y, 0.5f, -0.5f, {tl, br});
            set(rings[bl], x, y, -0.5f, 0.5f, {br, tl});
            set(rings[br], x, y, 0.5f, 0.5f, {tr, tl, bl});
            return;
        }
        const int dx = strip == Strip::kAlongX ? 1 : 0, dy = 1 - dx;
        const bool before = strip_at(grid_.mask, x - dx, y - dy) == strip,
                   after = strip_at(grid_.mask, x + dx, y + dy) == strip;
        const auto side = [&](int step, int n) { return vertex(x + step * dx, y + step * dy, n); };
        Ring &first = rings[side(0, 0)], &second = rings[side(0, 1)];
        set(first, x, y, -0.5f * static_cast<float>(dy), -0.5f * static_cast<float>(dx), {});
        set(second, x, y, 0.5f * static_cast<float>(dy), 0.5f * static_cast<float>(dx), {});
        // Along a row: up is the first side. Along a column everything is mirrored at the falling diagonal,
        // and so is the sense of turning.
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
    int width_, height_;
};

}  // namespace

RingMesh masked_rings(const GridMesh& grid) {
    return MaskedRings(grid).make();
}

}  // namespace imgmesh
