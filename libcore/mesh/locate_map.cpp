#include "libcore/mesh/locate_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/mesh/face_bins.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 16;

// Faces tried for a pixel in the mean: of photographs 2, and 20 where the smallest faces that pixels allow
// are all in one place. Positions from a file could all be in the bin of the most faces.
constexpr std::int64_t kMostTries = 64, kFreeTries = 1 << 22;

// Of a map in 1/2048, positions in large faces are known to less than the grid: so many grid points around
// are tried, in either direction.
constexpr int kFarthestSteps = 4;

// Rows of a map, by the faces and the grid of positions.
class Rows {
  public:
    Rows(const BaseMesh& mesh, const GridSize& image, WeightPrecision precision)
        : bins_(mesh, image),
          bits_(weight_bits(precision)),
          most_tries_(kMostTries * static_cast<std::int64_t>(image.pixel_count()) + kFreeTries) {}

    const FaceBins& bins() const { return bins_; }
    int bits() const { return bits_; }
    bool too_many_tries() const { return tries_ > most_tries_; }

    // Writes the coordinates of row y. Returns the column of the first pixel on no face, or the width.
    int locate(const Displacements& d, int y, std::span<PixelCoord> out) {
        const int units = kPixelUnits / d.steps;
        const std::size_t begin = d.row_begin(y);
        std::int64_t tries = 0;
        int x = 0;
        Id id = kNone;
        ExactFace face{};
        for (; x < d.width; ++x) {
            const std::size_t i = begin + as_index(x);
            if (!d.inside.contains(i)) {
                out[as_index(x)] = {};
                continue;
            }
            const GridPoint p{x * kPixelUnits + d.dx[i] * units, y * kPixelUnits + d.dy[i] * units};
            SideAreas areas = face.at(p);
            if (!areas.hold_strictly()) {
                id = bins_.find(p, tries);
                if (id == kNone) break;
                face = bins_.face(id);
                areas = face.at(p);
            }
            out[as_index(x)] = face.weights(id, areas, bits_);
        }
        tries_ += tries;
        return x;
    }

  private:
    FaceBins bins_;
    int bits_;
    std::int64_t most_tries_;
    std::atomic<std::int64_t> tries_{0};
};

// Finds displacements that give a map back.
class Inverse {
  public:
    Inverse(const BaseMesh& mesh, const PixelMap& map) : map_(map), rows_(mesh, map, map.precision) {
        if (std::any_of(map.begin(), map.end(), [](const PixelCoord& c) { return c.face == kNone; })) {
            inside_ = Mask(map, 1);
            for (std::size_t i = 0; i < map.size(); ++i) inside_[i] = map[i].face != kNone;
        }
    }

    std::optional<Displacements> on_grid(int steps) {
        Displacements d;
        static_cast<GridSize&>(d) = map_;
        d.steps = steps;
        d.dx.resize(map_.size());
        d.dy.resize(map_.size());
        d.inside = inside_;
        std::atomic<bool> failed{false};
        parallel_blocks(0, d.height, kGrainRows, [&](int first, int last) {
            std::vector<PixelCoord> back(as_index(d.width));
            for (int y = first; y < last && !failed; ++y)
                if (!find_row(d, y, back) || rows_.too_many_tries()) failed = true;
        });
        if (failed) return std::nullopt;
        return d;
    }

  private:
    bool find_row(Displacements& d, int y, std::span<PixelCoord> back) {
        const auto row = map_.row(y);
        for (int x = 0; x < d.width; ++x)
            if (row[as_index(x)].face != kNone && !find_pixel(d, x, y)) return false;
        return rows_.locate(d, y, back) == d.width && std::equal(back.begin(), back.end(), row.begin());
    }

    bool find_pixel(Displacements& d, int x, int y) {
        const std::size_t i = d.index(x, y);
        const PixelCoord& coord = map_[i];
        const ExactFace& face = rows_.bins().face(coord.face);
        const int units = kPixelUnits / d.steps, bits = rows_.bits();
        const auto one = static_cast<float>(1 << bits);
        const auto b = static_cast<std::int64_t>(coord.u * one), c = static_cast<std::int64_t>(coord.v * one);
        // bx, cx and the like are turned sides: b - a is (-cy, cx), and c - a is (by, -bx).
        const auto nearest = [&](std::int32_t from, std::int32_t to_b, std::int32_t to_c, int pixel) {
            const std::int64_t all =
                ((std::int64_t{from} - pixel * kPixelUnits) << bits) + b * to_b + c * to_c;
            const std::int64_t step = std::int64_t{units} << bits;
            return (all + step / 2) >> (bits + (units == 4 ? 2 : units == 2 ? 1 : 0));
        };
        const std::int64_t dx = nearest(face.a.x, -face.cy, face.by, x),
                           dy = nearest(face.a.y, face.cx, -face.bx, y);
        const auto fits = [&](std::int64_t at_x, std::int64_t at_y) {
            using Limits = std::numeric_limits<std::int16_t>;
            if (at_x != std::clamp<std::int64_t>(at_x, Limits::min(), Limits::max()) ||
                at_y != std::clamp<std::int64_t>(at_y, Limits::min(), Limits::max()))
                return false;
            d.dx[i] = static_cast<std::int16_t>(at_x);
            d.dy[i] = static_cast<std::int16_t>(at_y);
            const SideAreas areas =
                face.at({x * kPixelUnits + d.dx[i] * units, y * kPixelUnits + d.dy[i] * units});
            return face.area > 0 && areas.hold() && face.weights(coord.face, areas, bits) == coord;
        };
        if (fits(dx, dy)) return true;
        // A weight is off by less than a step and all by 0 together, so positions by less than a side's
        // share.
        const std::int64_t side =
            std::max({std::abs(face.bx), std::abs(face.by), std::abs(face.cx), std::abs(face.cy),
                      std::abs(face.bx + face.cx), std::abs(face.by + face.cy)});
        const std::int64_t reach = std::min<std::int64_t>(kFarthestSteps, (side >> bits) / units + 1);
        if (2 * side < std::int64_t{units} << bits) return false;
        for (std::int64_t ring = 1; ring <= reach; ++ring)
            for (std::int64_t oy = -ring; oy <= ring; ++oy)
                for (std::int64_t ox = -ring; ox <= ring; ++ox)
                    if (std::max(std::abs(ox), std::abs(oy)) == ring && fits(dx + ox, dy + oy)) return true;
        return false;
    }

    const PixelMap& map_;
    Rows rows_;
    Mask inside_;
};

}  // namespace

LocatedMap locate_map(const BaseMesh& mesh, const Displacements& displacements, WeightPrecision precision) {
    LocatedMap located;
    if (displacements.pixel_count() == 0) return located;
    Rows rows(mesh, displacements, precision);
    located.map = PixelMap(displacements.width, displacements.height,
                           parallel_vector<PixelCoord>(displacements.pixel_count()), precision);
    std::atomic<std::size_t> lost{std::numeric_limits<std::size_t>::max()};
    parallel_blocks(0, displacements.height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y) {
            if (displacements.row_begin(y) > lost || rows.too_many_tries()) return;
            const int x = rows.locate(displacements, y, located.map.row(y));
            if (x == displacements.width) continue;
            const std::size_t pixel = displacements.index(x, y);
            for (std::size_t before = lost; pixel < before && !lost.compare_exchange_weak(before, pixel);) {
            }
            return;
        }
    });
    if (rows.too_many_tries())
        throw Error(ErrorKind::kUnsupported,
                    "too many faces of the mesh lie at one place to find its pixels");
    if (lost != std::numeric_limits<std::size_t>::max()) {
        located.lost = lost;
        located.map = {};
    }
    return located;
}

std::optional<Displacements> displacements_of(const BaseMesh& mesh, const PixelMap& map) {
    if (map.empty()) return std::nullopt;
    try {
        Inverse inverse(mesh, map);
        for (const int steps : {8, 16, 32})
            if (std::optional<Displacements> found = inverse.on_grid(steps)) return found;
    } catch (const Error&) {
        // The mesh is one that locate_map() refuses.
    }
    return std::nullopt;
}

}  // namespace imgmesh
