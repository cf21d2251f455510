// Finds the point of a warped image that each output pixel shows. The cells between four pixels are drawn at
// their new places, two triangles each. Internal to warp/: a template over what happens to the points.
//
// Places are whole multiples of 1/4096 output pixel, so the triangle that covers an output pixel's centre is
// decided exactly. Where nothing folds, exactly one triangle covers each centre inside the warped image. A
// centre on an edge belongs to the triangle that contains the points just to the right of it (or just below,
// for a horizontal edge).
#pragma once

#include <algorithm>
#include <cmath>

#include "libcore/base/parallel.h"
#include "libcore/warp/cell_places.h"

namespace imgmesh {

/// A point of the source inside a cell.
struct CellPoint {
    int x, y;      ///< the cell's top left pixel; -1 on the rim that surrounds the image
    float fx, fy;  ///< the point is (x + fx, y + fy); in [0, 1]
    /// How the point changes with a step of one output pixel to the right (dx) and down (dy) [source pixels].
    Vec2f dx, dy;
};

/// If several triangles cover a centre, the highest priority wins, then the later row, then the later column.
enum class Cover : std::uint8_t { kNothing, kTurnedBoundary, kBoundary, kTurned, kSolid };

/// Draws cells into the rows [first_row, last_row) of an output that is `width` pixels wide.
///
/// sink.copy(X, Y, x, y): output pixel (X, Y) shows source pixel (x, y) itself.
/// sink.plain(X, Y, x, y, fx, fy): it shows the point (x + fx, y + fy) of a hardly distorted solid cell.
/// sink.sample(X, Y, point): it shows a point of any other cell.
/// Later calls for one (X, Y) replace earlier ones.
template <typename Sink>
class CellRaster {
  public:
    CellRaster(const CellPlaces& places, int width, int first_row, int last_row, Sink& sink)
        : places_(places),
          width_(width),
          first_row_(first_row),
          last_row_(last_row),
          cover_({width, last_row - first_row}, Cover::kNothing),
          sink_(sink) {}

    void draw() {
        PlaceRow above, below;
        int have = -2;  // the row that `below` holds now
        for (int y = -1; y < places_.height(); ++y) {
            if (!places_.reaches(y, first_row_, last_row_)) continue;
            if (have == y)
                std::swap(above, below);
            else
                places_.row(y, above);
            places_.row(have = y + 1, below);
            for (int x = -1; x < places_.width(); ++x) draw_cell(x, y, above, below);
        }
    }

  private:
    static constexpr int kOne = CellPlaces::kOne;

    struct Point {
        std::int32_t x, y;
    };
    // Source offset of a corner inside its cell.
    struct Corner {
        Point at;
        int sx, sy;
    };

    static Point point(const PlaceRow& row, int x) {
        const std::size_t i = as_index(x + 1);
        return {row.x[i], row.y[i]};
    }
    static std::int64_t cross(const Point& p, const Point& q, const Point& r) {
        return std::int64_t{q.x - p.x} * (r.y - p.y) - std::int64_t{q.y - p.y} * (r.x - p.x);
    }
    // The least value of cross(p, q, centre) for centres inside; see the top of the file.
    static std::int64_t least(const Point& p, const Point& q) {
        return q.y < p.y || (q.y == p.y && q.x > p.x) ? 0 : 1;
    }

    void draw_cell(int x, int y, const PlaceRow& above, const PlaceRow& below) {
        const Point a = point(above, x), b = point(above, x + 1), c = point(below, x),
                    d = point(below, x + 1);
        // Undistorted: the first corner lies on a centre, and the cell draws nothing else.
        if (((a.x | a.y) & (kOne - 1)) == 0 && b.x - a.x == kOne && b.y == a.y && c.x == a.x &&
            c.y - a.y == kOne && d.x == b.x && d.y == c.y) {
            const int column = a.x / kOne, row = a.y / kOne;
            if (x < 0 || y < 0 || a.x < 0 || column >= width_ || row < first_row_ || row >= last_row_) return;
            const Cover cover = places_.cover(x, y);
            if (cover != Cover::kNothing && take(column, row, cover)) sink_.copy(column, row, x, y);
            return;
        }
        if (is_mild(a, b, c, d) && places_.cover(x, y) == Cover::kSolid) {
            draw_mild(x, y, a, b, c, d);
            return;
        }
        const int left = std::max((std::min({a.x, b.x, c.x, d.x}) + kOne - 1) >> CellPlaces::kBits, 0),
                  right = std::min(std::max({a.x, b.x, c.x, d.x}) >> CellPlaces::kBits, width_ - 1);
        if (left > right) return;
        const int top =
                      std::max((std::min({a.y, b.y, c.y, d.y}) + kOne - 1) >> CellPlaces::kBits, first_row_),
                  bottom = std::min(std::max({a.y, b.y, c.y, d.y}) >> CellPlaces::kBits, last_row_ - 1);
        if (top > bottom) return;
        const Cover cover = places_.cover(x, y);
        if (cover == Cover::kNothing) return;
        const Corner ca{a, 0, 0}, cb{b, 1, 0}, cc{c, 0, 1}, cd{d, 1, 1};
        // Cut from top left to bottom right, or the other way if only that leaves no half turned over.
        const bool turned = cross(a, b, d) <= 0 || cross(a, d, c) <= 0;
        if (turned && cross(a, b, c) > 0 && cross(b, d, c) > 0) {
            draw_triangle(x, y, cover, ca, cb, cc);
            draw_triangle(x, y, cover, cb, cd, cc);
        } else {
            draw_triangle(x, y, cover, ca, cb, cd);
            draw_triangle(x, y, cover, ca, cd, cc);
        }
    }

    // Whether every side differs from an undistorted one by less than an eighth of a pixel in x and in y.
    // Then no triangle is turned over, products fit 32 bits, and a step of one output pixel is less than 1.34
    // source pixels.
    static bool is_mild(const Point& a, const Point& b, const Point& c, const Point& d) {
        constexpr std::uint32_t kReach = kOne / 8;
        const auto near = [](std::int32_t value) {
            return static_cast<std::uint32_t>(value) + kReach < 2 * kReach;
        };
        return near(b.x - a.x - kOne) & near(b.y - a.y) & near(c.x - a.x) & near(c.y - a.y - kOne) &
               near(d.x - c.x - kOne) & near(d.y - c.y) & near(d.x - b.x) & near(d.y - b.y - kOne);
    }

    // Does the same as draw_cell and draw_triangle in a third of the time, for slightly distorted cells,
    // which most are: the diagonal decides which of the two triangles contains a centre.
    void draw_mild(int x, int y, const Point& a, const Point& b, const Point& c, const Point& d) {
        const int left = std::max((std::min(a.x, c.x) + kOne - 1) >> CellPlaces::kBits, 0),
                  right = std::min(std::max(b.x, d.x) >> CellPlaces::kBits, width_ - 1),
                  top = std::max((std::min(a.y, b.y) + kOne - 1) >> CellPlaces::kBits, first_row_),
                  bottom = std::min(std::max(c.y, d.y) >> CellPlaces::kBits, last_row_ - 1);
        for (int row = top; row <= bottom; ++row)
            for (int column = left; column <= right; ++column) {
                const Point p{column * kOne, row * kOne};
                const auto e = near_cross(a, d, p);
                if (e >= least(a, d)) {
                    const auto wa = near_cross(d, c, p), wd = near_cross(c, a, p);
                    if (wa < least(d, c) || wd < least(c, a) || !take(column, row, Cover::kSolid)) continue;
                    const auto area = static_cast<float>(wa + wd + e);
                    sink_.plain(column, row, x, y, static_cast<float>(wd) / area,
                                static_cast<float>(wd + e) / area);
                } else {
                    const auto wa = near_cross(b, d, p), wd = near_cross(a, b, p);
                    if (wa < least(b, d) || wd < least(a, b) || !take(column, row, Cover::kSolid)) continue;
                    const auto area = static_cast<float>(wa + wd - e);
                    sink_.plain(column, row, x, y, static_cast<float>(wd - e) / area,
                                static_cast<float>(wd) / area);
                }
            }
    }
    static std::int32_t near_cross(const Point& p, const Point& q, const Point& r) {
        return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    }

    void draw_triangle(int x, int y, Cover cover, const Corner& p, Corner q, Corner r) {
        std::int64_t area = cross(p.at, q.at, r.at);
        if (area == 0) return;
        if (area < 0) {
            std::swap(q, r);
            area = -area;
            cover = static_cast<Cover>(static_cast<int>(cover) - 1);
        }
        const Point &a = p.at, &b = q.at, &c = r.at;
        const int left = std::max((std::min({a.x, b.x, c.x}) + kOne - 1) >> CellPlaces::kBits, 0),
                  right = std::min(std::max({a.x, b.x, c.x}) >> CellPlaces::kBits, width_ - 1),
                  top = std::max((std::min({a.y, b.y, c.y}) + kOne - 1) >> CellPlaces::kBits, first_row_),
                  bottom = std::min(std::max({a.y, b.y, c.y}) >> CellPlaces::kBits, last_row_ - 1);
        if (left > right || top > bottom) return;
        const Point start{left * kOne, top * kOne};
        // Twice the areas opposite the corners a, b, c, minus their least values.
        const std::int64_t least_a = least(b, c), least_b = least(c, a), least_c = least(a, b);
        std::int64_t row_a = cross(b, c, start) - least_a, row_b = cross(c, a, start) - least_b,
                     row_c = cross(a, b, start) - least_c;
        const std::int64_t step_a = std::int64_t{b.y - c.y} * kOne, step_b = std::int64_t{c.y - a.y} * kOne,
                           step_c = std::int64_t{a.y - b.y} * kOne;
        const double inverse = 1 / double(area);
        CellPoint point{x, y, 0, 0, {}, {}};
        bool ready = false;
        for (int row = top; row <= bottom; ++row) {
            std::int64_t ea = row_a, eb = row_b, ec = row_c;
            for (int column = left; column <= right; ++column) {
                if ((ea | eb | ec) >= 0 && take(column, row, cover)) {
                    if (!ready) {
                        derivatives(p, q, r, inverse, point);
                        ready = true;
                    }
                    // These are sums of whole numbers, so a centre on a corner gives exactly 0 and 1.
                    const std::int64_t wa = ea + least_a, wb = eb + least_b, wc = ec + least_c;
                    point.fx = static_cast<float>(double(wa * p.sx + wb * q.sx + wc * r.sx) * inverse);
                    point.fy = static_cast<float>(double(wa * p.sy + wb * q.sy + wc * r.sy) * inverse);
                    sink_.sample(column, row, point);
                }
                ea += step_a;
                eb += step_b;
                ec += step_c;
            }
            row_a += std::int64_t{c.x - b.x} * kOne;
            row_b += std::int64_t{a.x - c.x} * kOne;
            row_c += std::int64_t{b.x - a.x} * kOne;
        }
    }

    static void derivatives(const Corner& p, const Corner& q, const Corner& r, double inverse,
                            CellPoint& point) {
        const Point &a = p.at, &b = q.at, &c = r.at;
        const double scale = kOne * inverse;
        const auto slope = [&](int sp, int sq, int sr, int ea, int eb, int ec) {
            return static_cast<float>((double(sp) * ea + double(sq) * eb + double(sr) * ec) * scale);
        };
        const int xa = b.y - c.y, xb = c.y - a.y, xc = a.y - b.y, ya = c.x - b.x, yb = a.x - c.x,
                  yc = b.x - a.x;
        point.dx = {slope(p.sx, q.sx, r.sx, xa, xb, xc), slope(p.sy, q.sy, r.sy, xa, xb, xc)};
        point.dy = {slope(p.sx, q.sx, r.sx, ya, yb, yc), slope(p.sy, q.sy, r.sy, ya, yb, yc)};
    }

    bool take(int column, int row, Cover cover) {
        Cover& at = cover_.at(column, row - first_row_);
        if (cover < at) return false;
        at = cover;
        return true;
    }

    const CellPlaces& places_;
    int width_, first_row_, last_row_;
    Grid<Cover> cover_;
    Sink& sink_;
};

/// Draws all cells into a width x height output, in bands of rows. The bands share `sink`, and each output
/// pixel belongs to one band only. The calls for a pixel and their order are the same for any number of
/// threads.
template <typename Sink>
void raster_cells(const CellPlaces& places, int width, int height, Sink& sink) {
    // This share of rows spreads the work well, and few source rows lie in two bands.
    constexpr int kBandRows = 64;
    parallel_blocks(0, height, kBandRows,
                    [&](int first, int last) { CellRaster<Sink>(places, width, first, last, sink).draw(); });
}

}  // namespace imgmesh
