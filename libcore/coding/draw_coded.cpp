#include "libcore/coding/draw_coded.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "libcore/base/index.h"
#include "libcore/coding/integer_math.h"

namespace imgmesh::coding {
namespace {

// Vertices lie on a grid of 1/16 pixel of the drawing; the grid of the file at its own size is a part of it.
constexpr int kSub = 16;
// Colours of pixels have 16 fractional bits, those of vertices 6.
constexpr int kOne = 1 << 16, kToPixel = kOne / kColorUnit;

struct Point {
    std::int64_t x, y;
};

// A vertex of the image's side `from` on an output of side `to`. The outermost half pixels belong to the
// border's vertices.
std::int64_t place(int at, int last, int from, int to) {
    const std::int64_t twice = std::int64_t{8} * (at + 2) * to + from;
    const std::int64_t out = floor_divide(twice, 2 * from) - kSub / 2;
    if (at == 0) return std::min<std::int64_t>(out, 0);
    if (at == last) return std::max<std::int64_t>(out, kSub * (std::int64_t{to} - 1));
    return out;
}

// Adds to colours wrap around: the planes of thin faces rise too steeply for 32 bits, but where they are
// drawn their values are those of a mean of vertices.
std::int32_t wrapped(std::int64_t value) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(value));
}

std::uint8_t level_of(std::int32_t value) {
    return static_cast<std::uint8_t>(std::clamp((value + kOne / 2) >> 16, 0, 255));
}

template <int Channels>
class Drawing {
  public:
    Drawing(int width, int height, std::vector<std::uint8_t>& out)
        : width_(width), height_(height), out_(out) {}

    // The corners must run so that their area is positive where y points down and x to the right.
    void draw(const std::array<Point, 3>& p, const std::array<const std::int32_t*, 3>& color) {
        const std::int64_t top = std::min({p[0].y, p[1].y, p[2].y}),
                           bottom = std::max({p[0].y, p[1].y, p[2].y});
        const auto first = std::max<std::int64_t>((top + kSub - 1) / kSub, 0),
                   last = std::min<std::int64_t>(bottom >> 4, height_ - 1);
        Plane plane;
        bool placed = false;
        for (std::int64_t y = first; y <= last; ++y) {
            std::int64_t from = 0, to = width_ - 1;
            for (std::size_t i = 0; i < 3; ++i) narrow(p[i], p[(i + 1) % 3], y, from, to);
            if (from > to) continue;
            if (!placed) plane = plane_at(p, color, from, y);
            placed = true;
            draw_row(plane, y, from, to);
        }
    }

  private:
    // The colour at one pixel, and what it gains in a step to the right and down.
    struct Plane {
        std::int64_t x, y;
        std::array<std::int32_t, Channels> at, right, down;
    };

    // Keeps those pixels of row y that lie on the inner side of the edge from a to b.
    static void narrow(const Point& a, const Point& b, std::int64_t y, std::int64_t& from, std::int64_t& to) {
        const std::int64_t rise = b.y - a.y;
        const std::int64_t rest = (b.x - a.x) * (kSub * y - a.y) + rise * a.x;
        if (rise < 0)
            from = std::max(from, -floor_divide(rest, -kSub * rise));
        else if (rise > 0)
            to = std::min(to, floor_divide(rest, kSub * rise));
    }

    static Plane plane_at(const std::array<Point, 3>& p, const std::array<const std::int32_t*, 3>& color,
                          std::int64_t x, std::int64_t y) {
        const Point u{p[1].x - p[0].x, p[1].y - p[0].y}, v{p[2].x - p[0].x, p[2].y - p[0].y};
        const Point w{kSub * x - p[0].x, kSub * y - p[0].y};
        const std::int64_t area = u.x * v.y - u.y * v.x;
        const std::int64_t weight1 = w.x * v.y - w.y * v.x, weight2 = u.x * w.y - u.y * w.x;
        Plane plane{x, y, {}, {}, {}};
        for (std::size_t c = 0; c < Channels; ++c) {
            const std::int64_t base = color[0][c], d1 = color[1][c] - base, d2 = color[2][c] - base;
            const std::int64_t above = weight1 * d1 + weight2 * d2, whole = floor_divide(above, area);
            const std::int64_t part = floor_divide(2 * kToPixel * (above - whole * area) + area, 2 * area);
            plane.at[c] = wrapped((base + whole) * kToPixel + part);
            plane.right[c] = wrapped(rounded(kSub * kToPixel * (d1 * v.y - d2 * u.y), area));
            plane.down[c] = wrapped(rounded(kSub * kToPixel * (d2 * u.x - d1 * v.x), area));
        }
        return plane;
    }
    static std::int64_t rounded(std::int64_t numerator, std::int64_t divisor) {
        return floor_divide(numerator + divisor / 2, divisor);
    }

    void draw_row(const Plane& plane, std::int64_t y, std::int64_t from, std::int64_t to) {
        std::array<std::int32_t, Channels> value;
        for (std::size_t c = 0; c < Channels; ++c)
            value[c] =
                wrapped(plane.at[c] + plane.right[c] * (from - plane.x) + plane.down[c] * (y - plane.y));
        std::uint8_t* out = out_.data() + (y * width_ + from) * Channels;
        for (std::int64_t x = from; x <= to; ++x, out += Channels) {
            write(value, out);
            for (std::size_t c = 0; c < Channels; ++c)
                value[c] = wrapped(std::int64_t{value[c]} + plane.right[c]);
        }
    }

    static void write(const std::array<std::int32_t, Channels>& value, std::uint8_t* out) {
        for (std::size_t c = 0; c < Channels; ++c) out[c] = level_of(value[c]);
        if constexpr (Channels % 2 == 0) {
            const std::uint8_t alpha = out[Channels - 1];
            if (alpha == 255) return;
            const std::int64_t divisor = value[Channels - 1];
            for (std::size_t c = 0; c + 1 < Channels; ++c)
                out[c] =
                    alpha == 0
                        ? std::uint8_t{0}
                        : static_cast<std::uint8_t>(std::clamp<std::int64_t>(
                              floor_divide(255 * std::int64_t{value[c]} + divisor / 2, divisor), 0, 255));
        }
    }

    int width_, height_;
    std::vector<std::uint8_t>& out_;
};

template <int Channels>
void draw_faces(const CodedShape& shape, std::span<const Point> places, std::span<const std::int32_t> color,
                int width, int height, std::vector<std::uint8_t>& out) {
    Drawing<Channels> drawing(width, height, out);
    for (Face face : shape.faces) {
        std::array<Point, 3> p{places[face[0]], places[face[1]], places[face[2]]};
        const std::int64_t area =
            (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
        if (area == 0) continue;
        if (area < 0) {
            std::swap(face[1], face[2]);
            std::swap(p[1], p[2]);
        }
        drawing.draw(p, {color.data() + Channels * face[0], color.data() + Channels * face[1],
                         color.data() + Channels * face[2]});
    }
}

}  // namespace

std::vector<std::uint8_t> draw_coded(const CodedShape& shape, std::span<const std::int32_t> color,
                                     int channels, int width, int height) {
    assert(width > 0 && height > 0 && color.size() == shape.point.size() * as_index(channels));
    const CodedGrid& grid = shape.grid;
    // One column of a mesh that has only one is drawn, and repeated.
    const int columns = grid.width == 1 ? 1 : width, rows = grid.height == 1 ? 1 : height;
    std::vector<Point> places(shape.point.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto [column, row] = shape.point[i];
        places[i] = {place(grid.x(column), grid.right(), grid.width, columns),
                     place(grid.y(row), grid.bottom(), grid.height, rows)};
    }
    const std::size_t across = as_index(columns), depth = as_index(channels);
    std::vector<std::uint8_t> out(across * as_index(rows) * depth);
    switch (channels) {
        case 1:
            draw_faces<1>(shape, places, color, columns, rows, out);
            break;
        case 2:
            draw_faces<2>(shape, places, color, columns, rows, out);
            break;
        case 3:
            draw_faces<3>(shape, places, color, columns, rows, out);
            break;
        default:
            draw_faces<4>(shape, places, color, columns, rows, out);
    }
    if (columns == width && rows == height) return out;
    std::vector<std::uint8_t> repeated(as_index(width) * as_index(height) * depth);
    for (std::size_t y = 0, at = 0; y < as_index(height); ++y)
        for (std::size_t x = 0; x < as_index(width); ++x)
            for (std::size_t c = 0; c < depth; ++c, ++at)
                repeated[at] =
                    out[(std::min(y, as_index(rows - 1)) * across + std::min(x, across - 1)) * depth + c];
    return repeated;
}

}  // namespace imgmesh::coding
