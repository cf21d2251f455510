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

// Rows of one block: enough work to be worth handing over, few enough for every thread to get some.
constexpr int kGrainRows = 16;

class MaskedRings {
  public:
    explicit MaskedRings(const GridMesh& grid) : grid_(grid) {}

    PixelRings at(int x, int y) const {
        PixelRings out;
        if (const Strip strip = strip_at(grid_.mask, x, y); strip != Strip::kNoStrip) {
            add_strip(out, strip, x, y);
        } else {
            const PixelFans fans = fans_of(x, y);
            for (std::size_t f = 0; f < fans.count; ++f) add(out, x, y) = ring(fans.fan[f], x, y);
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
    Id vertex(int x, int y, std::size_t n) const {
        const Id pixel = as_id(grid_.feature.index(x, y));
        if (n == 0) return pixel;
        const auto first = std::lower_bound(grid_.copies.begin(), grid_.copies.end(), pixel);
        return as_id(grid_.feature.pixel_count() + as_index(first - grid_.copies.begin()) + n - 1);
    }

    // Adds the next vertex of the pixel.
    Ring& add(PixelRings& pixel, int x, int y) const {
        pixel.vertex[pixel.count] = vertex(x, y, pixel.count);
        return pixel.ring[pixel.count++];
    }

    Ring ring(const Fan& fan, int x, int y) const {
        Ring ring;
        ring.x = static_cast<float>(x);
        ring.y = static_cast<float>(y);
        ring.fixed = fan.closed ? 0 : open_fan_fixed(fan, x, y);
        for (std::size_t k = 0; k < fan.count; ++k) {
            const int d = fan.direction[k];
            const int nx = x + kAround[d].dx, ny = y + kAround[d].dy;
            // An edge is in one fan of its other end: its two faces are neighbours there too.
            const PixelFans fans = fans_of(nx, ny);
            std::size_t n = 0;
            while (!fans.fan[n].has((d + 4) % 8)) ++n;
            ring.neighbor[ring.valence++] = vertex(nx, ny, n);
        }
        return ring;
    }

    // All corners, but for pixels that must go from a side: their boundary runs along that side.
    std::uint8_t open_fan_fixed(const Fan& fan, int x, int y) const {
        if (grid_.side_vertices.empty() || grid_.keeps(as_id(grid_.feature.index(x, y)))) return kCorner;
        const PixelStep first = kAround[fan.direction[0]], last = kAround[fan.direction[fan.count - 1]];
        if (first.dx == 0 && last.dx == 0 && (x == 0 || x == grid_.feature.width - 1)) return kFixedX;
        if (first.dy == 0 && last.dy == 0 && (y == 0 || y == grid_.feature.height - 1)) return kFixedY;
        return kCorner;
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
        const auto side = [&](int step, std::size_t n) { return vertex(x + step * dx, y + step * dy, n); };
        Ring &first = add(out, x, y), &second = add(out, x, y);
        set(first, x, y, -0.5f * static_cast<float>(dy), -0.5f * static_cast<float>(dx), {});
        set(second, x, y, 0.5f * static_cast<float>(dy), 0.5f * static_cast<float>(dx), {});
        // Along a row the upper side comes first. Along a column everything is mirrored at the falling
        // diagonal, including the sense of turning.
        const auto push = [](Ring& ring, Id v) { ring.neighbor[ring.valence++] = v; };
        if (before) push(first, side(-1, 0));
        push(first, side(0, 1));
        if (after) {
            push(first, side(1, 1));
            push(first, side(1, 0));
            push(second, side(1, 1));
        }
        push(second, side(0, 0));
        if (before) {
            push(second, side(-1, 0));
            push(second, side(-1, 1));
        }
        if (strip == Strip::kAlongY)
            for (Ring* ring : {&first, &second}) std::reverse(ring->neighbor, ring->neighbor + ring->valence);
    }

    static void set(Ring& ring, int x, int y, float dx, float dy, std::initializer_list<Id> neighbors) {
        ring.x = static_cast<float>(x) + dx;
        ring.y = static_cast<float>(y) + dy;
        ring.fixed = kCorner;
        std::copy(neighbors.begin(), neighbors.end(), ring.neighbor);
        ring.valence = static_cast<std::uint8_t>(neighbors.size());
    }

    const GridMesh& grid_;
};

}  // namespace

PixelRings masked_pixel_rings(const GridMesh& grid, int x, int y) {
    return MaskedRings(grid).at(x, y);
}

Vec2f vertex_place(const GridMesh& grid, Id vertex) {
    const Id pixel = grid.pixel_of(vertex);
    const int x = grid.feature.x_of(pixel), y = grid.feature.y_of(pixel);
    if (!grid.mask.empty() && strip_at(grid.mask, x, y) != Strip::kNoStrip) {
        const PixelRings rings = masked_pixel_rings(grid, x, y);
        for (std::size_t n = 0; n < rings.count; ++n)
            if (rings.vertex[n] == vertex) return {rings.ring[n].x, rings.ring[n].y};
    }
    return {grid.origin_x + static_cast<float>(x), grid.origin_y + static_cast<float>(y)};
}

std::int64_t masked_face_count(const GridMesh& grid) {
    const Mask& mask = grid.mask;
    std::vector<std::int64_t> rows(as_index(mask.height), 0);
    parallel_blocks(0, mask.height, kGrainRows, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < mask.width; ++x) {
                std::int64_t& faces = rows[as_index(y)];
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

std::int64_t side_vertices_to_go(const GridMesh& grid) {
    if (grid.side_vertices.empty()) return 0;
    std::int64_t count = 0;
    const auto add = [&](int x, int y) {
        const auto goes = [](const Ring& ring) { return ring.border() && ring.fixed != kCorner; };
        if (grid.mask.empty()) {
            count += goes(grid_ring(grid, x, y));
        } else {
            const PixelRings rings = masked_pixel_rings(grid, x, y);
            for (std::size_t n = 0; n < rings.count; ++n) count += goes(rings.ring[n]);
        }
    };
    const int w = grid.feature.width, h = grid.feature.height;
    for (int x = 0; x < w; ++x) {
        add(x, 0);
        add(x, h - 1);
    }
    for (int y = 1; y + 1 < h; ++y) {
        add(0, y);
        add(w - 1, y);
    }
    return count;
}

RingMesh masked_rings(const GridMesh& grid) {
    RingMesh rings(grid.vertex_count());
    parallel_blocks(0, grid.feature.height, kGrainRows, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < grid.feature.width; ++x) {
                const PixelRings pixel = masked_pixel_rings(grid, x, y);
                for (std::size_t n = 0; n < pixel.count; ++n) rings[pixel.vertex[n]] = pixel.ring[n];
            }
    });
    return rings;
}

}  // namespace imgmesh
