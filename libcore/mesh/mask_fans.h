// The dense mesh at one pixel of a masked image: its fans of triangles, or the strip to which it belongs.
#pragma once

#include <array>
#include <cstdint>

#include "libcore/image/mask.h"

namespace imgmesh {

/// The eight pixels around one, counter-clockwise on screen from the east; odd indices are diagonals.
struct PixelStep {
    int dx, dy;
};
inline constexpr PixelStep kAround[8] = {{1, 0},  {1, -1}, {0, -1}, {-1, -1},
                                         {-1, 0}, {-1, 1}, {0, 1},  {1, 1}};

/// Consecutive triangles around a pixel, as the directions (indices into kAround) of their other corners in
/// counter-clockwise order. A closed fan does not repeat its first direction.
struct Fan {
    std::array<std::uint8_t, 8> direction{};
    std::size_t count = 0;
    bool closed = false;

    void add(std::uint8_t d) { direction[count++] = d; }
    bool has(int d) const {
        for (std::size_t k = 0; k < count; ++k)
            if (direction[k] == d) return true;
        return false;
    }
};

/// All fans of a pixel. Each is a vertex of its own; there are several where the mask pinches.
struct PixelFans {
    std::array<Fan, 4> fan;
    std::size_t count = 0;
};

/// diagonal_through(q): whether the diagonal of cell q (of directions 2q to 2q + 2) ends at this pixel.
/// None for a pixel outside, or inside of which every cell has fewer than three pixels inside.
template <typename DiagonalThrough>
PixelFans fans_at(const Mask& mask, int x, int y, const DiagonalThrough& diagonal_through) {
    PixelFans out;
    if (!mask.at(x, y)) return out;
    bool inside[8];
    for (int d = 0; d < 8; ++d) inside[d] = mask.at(x + kAround[d].dx, y + kAround[d].dy);
    // The triangles, each from one direction to another.
    std::array<std::array<std::uint8_t, 2>, 8> faces{};
    std::size_t count = 0;
    const auto add = [&](std::uint8_t from, std::uint8_t to) { faces[count++] = {from, to}; };
    // The directions of each cell: its first straight one, its diagonal, its second straight one.
    constexpr std::uint8_t kCells[4][3] = {{0, 1, 2}, {2, 3, 4}, {4, 5, 6}, {6, 7, 0}};
    for (int q = 0; q < 4; ++q) {
        const auto [a, d, b] = kCells[q];
        if (inside[a] && inside[b] && !(inside[d] && diagonal_through(q))) {
            add(a, b);
        } else {
            if (inside[a] && inside[d]) add(a, d);
            if (inside[d] && inside[b]) add(d, b);
        }
    }
    const auto follows = [&](std::size_t k) {  // face k on the one before it
        return faces[(k + count - 1) % count][1] == faces[k][0];
    };
    std::size_t first = 0;
    while (first < count && follows(first)) ++first;
    if (count == 0) return out;
    const bool closed = first == count;
    for (std::size_t n = 0; n < count; ++n) {
        const std::size_t k = closed ? n : (first + n) % count;
        const auto [from, to] = faces[k];
        if (n == 0 || (!closed && !follows(k))) {
            Fan& fan = out.fan[out.count++];
            fan.closed = closed;
            fan.add(from);
        }
        if (!closed || n + 1 < count) out.fan[out.count - 1].add(to);
    }
    return out;
}

/// How a pixel that is inside the mask but in no triangle is meshed: as part of a strip one pixel wide along
/// a row or a column, or as a square of its own.
enum class Strip { kNoStrip, kAlongX, kAlongY, kAlone };
Strip strip_at(const Mask& mask, int x, int y);

}  // namespace imgmesh
