#include "libcore/mesh/locate_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/mesh/face_bins.h"
#include "libcore/mesh/pixel_run.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 16;

// Faces tried for a pixel in the mean: of photographs 2, and 20 where the smallest faces that pixels allow
// are all in one place. Positions from a file could all be in the bin of the most faces.
constexpr std::int64_t kMostTries = 64, kFreeTries = 1 << 22;

// Of a map in 1/2048, positions in large faces are known to less than the grid: so many grid points around
// are tried, in either direction, and along the longest side.
constexpr std::int64_t kFarthestSteps = 4, kFarthestAlong = 64;

// Where a pixel is on the mesh, if a step is that many units.
GridPoint position(const Displacements& d, int units, int x, int y) {
    const std::size_t pixel = d.index(x, y);
    return {x * kPixelUnits + d.dx[pixel] * units, y * kPixelUnits + d.dy[pixel] * units};
}

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
    // The face that holds p; kNone if there is none.
    Id find(GridPoint p) {
        std::int64_t tries = 0;
        const Id id = bins_.find(p, tries);
        tries_ += tries;
        return id;
    }

    // What a thread needs for rows one after the other.
    struct Scratch {
        Scratch(int width, WeightPrecision precision) : ids(as_index(width), kNone), run(precision) {}
        std::vector<Id> ids;  // the faces of the row, and beyond the pixel at hand those of the row before
        PixelRun run;
        std::vector<std::pair<int, PixelCoord>> large;  // pixels whose faces are too large for `run`
    };

    // Writes the coordinates of row y. Returns the column of the first pixel on no face, or the width.
    int locate(const Displacements& d, int y, Scratch& scratch, std::span<PixelCoord> out) {
        std::int64_t tries = 0;
        int x = 0;
        while (x < d.width) {
            const int count = std::min(d.width - x, PixelRun::kPixels);
            const int found = find_faces(d, x, y, count, scratch, tries);
            scratch.run.divide(found);
            for (int i = 0; i < found; ++i) {
                const Id id = scratch.ids[as_index(x + i)];
                out[as_index(x + i)] =
                    id == kNone ? PixelCoord{} : PixelCoord{id, scratch.run.u(i), scratch.run.v(i)};
            }
            for (const auto& [i, coord] : scratch.large) out[as_index(x + i)] = coord;
            x += found;
            if (found < count) break;
        }
        tries_ += tries;
        return x;
    }

  private:
    // Finds the faces of `count` pixels from column x on. Returns the first that has none, or `count`.
    int find_faces(const Displacements& d, int x, int y, int count, Scratch& scratch, std::int64_t& tries) {
        const std::size_t begin = d.index(x, y);
        const int units = kPixelUnits / d.steps;
        const std::int64_t large = scratch.run.most_area();
        scratch.large.clear();
        ExactFace face{};
        Id id = kNone;
        for (int i = 0; i < count; ++i) {
            const std::size_t pixel = begin + as_index(i);
            Id& above = scratch.ids[as_index(x + i)];
            if (!d.inside.contains(pixel)) {
                above = kNone;
                continue;
            }
            const GridPoint p = position(d, units, x + i, y);
            SideAreas areas = face.at(p);
            if (!areas.hold_strictly()) {
                id = above != kNone && bins_.face(above).at(p).hold_strictly() ? above : bins_.find(p, tries);
                if (id == kNone) return i;
                face = bins_.face(id);
                areas = face.at(p);
            }
            above = id;
            scratch.run.put(i, face, areas);
            if (face.area > large) scratch.large.emplace_back(i, face.weights(id, areas, bits_));
        }
        return count;
    }

    FaceBins bins_;
    int bits_;
    std::int64_t most_tries_;
    std::atomic<std::int64_t> tries_{0};
};

// Finds displacements that give a map back.
class Inverse {
  public:
    Inverse(const BaseMesh& mesh, const PixelMap& map, const Displacements* made_of)
        : map_(map), made_of_(made_of), rows_(mesh, map, map.precision) {
        static_cast<GridSize&>(found_) = map;
        found_.dx = parallel_vector<std::int16_t>(map.size());
        found_.dy = parallel_vector<std::int16_t>(map.size());
        if (std::any_of(map.begin(), map.end(), [](const PixelCoord& c) { return c.face == kNone; })) {
            found_.inside = Mask(map, 1);
            for (std::size_t i = 0; i < map.size(); ++i) found_.inside[i] = map[i].face != kNone;
        }
    }

    bool find(int steps) {
        found_.steps = steps;
        std::atomic<bool> failed{false};
        parallel_blocks(0, map_.height, kGrainRows, [&](int first, int last) {
            if (failed) return;
            std::vector<PixelCoord> back(as_index(map_.width));
            Rows::Scratch scratch(map_.width, map_.precision);
            for (int y = first; y < last && !failed; ++y)
                if (!find_row(found_, y, scratch, back) || rows_.too_many_tries()) failed = true;
        });
        return !failed;
    }

    Displacements found() && { return std::move(found_); }

  private:
    bool find_row(Displacements& d, int y, Rows::Scratch& scratch, std::span<PixelCoord> back) {
        const auto row = map_.row(y);
        if (!set_nearest(d, y)) return false;
        if (made_of_ && made_of_->steps == d.steps && same_row(d, *made_of_, y)) return true;
        const auto comes_back = [&] {
            return rows_.locate(d, y, scratch, back) == d.width &&
                   std::equal(back.begin(), back.end(), row.begin());
        };
        if (comes_back()) return true;
        for (int x = 0; x < d.width; ++x)
            if (row[as_index(x)].face != kNone && !fits(d, x, y) && !search(d, x, y)) return false;
        return comes_back();
    }

    static bool same_row(const Displacements& a, const Displacements& b, int y) {
        const auto begin = static_cast<std::ptrdiff_t>(a.row_begin(y)), end = begin + a.width;
        return std::equal(a.dx.begin() + begin, a.dx.begin() + end, b.dx.begin() + begin) &&
               std::equal(a.dy.begin() + begin, a.dy.begin() + end, b.dy.begin() + begin);
    }

    // Finds grid points of a map with so many steps.
    struct Rounding {
        Rounding(int steps, int weight_bits)
            : bits(weight_bits),
              shift(bits + (steps == 8    ? 2
                            : steps == 16 ? 1
                                          : 0)),
              half((std::int64_t{1} << shift) / 2),
              one(static_cast<float>(1 << bits)) {}

        // Returns the grid point nearest to where the map has the pixel, as a displacement.
        IMGMESH_INLINE GridPoint nearest(const ExactFace& face, const PixelCoord& coord, int x, int y) const {
            const auto b = static_cast<std::int64_t>(coord.u * one),
                       c = static_cast<std::int64_t>(coord.v * one);
            const auto rounded = [&](std::int32_t from, std::int32_t to_b, std::int32_t to_c) {
                return static_cast<std::int32_t>(
                    ((std::int64_t{from} << bits) + b * to_b + c * to_c + half) >> shift);
            };
            // The gradients are turned sides: b - a is (-cy, cx), and c - a is (by, -bx).
            return {rounded(face.a.x - x * kPixelUnits, -face.cy, face.by),
                    rounded(face.a.y - y * kPixelUnits, face.cx, -face.bx)};
        }

        int bits, shift;
        std::int64_t half;
        float one;
    };

    GridPoint nearest(int steps, int x, int y) const {
        const PixelCoord& coord = map_.at(x, y);
        return Rounding(steps, rows_.bits()).nearest(rows_.bins().face(coord.face), coord, x, y);
    }

    // Sets a row. Returns whether all displacements have 16 bits.
    bool set_nearest(Displacements& d, int y) const {
        const Rounding rounding(d.steps, rows_.bits());
        const PixelCoord* row = map_.row(y).data();
        std::int16_t *dx = d.dx.data() + d.row_begin(y), *dy = d.dy.data() + d.row_begin(y);
        const FaceBins& bins = rows_.bins();
        const int width = d.width;
        bool fit = true;
        for (int x = 0; x < width; ++x) {
            if (row[x].face == kNone) continue;
            const GridPoint by = rounding.nearest(bins.face(row[x].face), row[x], x, y);
            dx[x] = static_cast<std::int16_t>(by.x);
            dy[x] = static_cast<std::int16_t>(by.y);
            fit &= (dx[x] == by.x) & (dy[x] == by.y);
        }
        return fit;
    }

    static bool set(Displacements& d, int x, int y, GridPoint by) {
        d.dx[d.index(x, y)] = static_cast<std::int16_t>(by.x);
        d.dy[d.index(x, y)] = static_cast<std::int16_t>(by.y);
        return d.dx[d.index(x, y)] == by.x && d.dy[d.index(x, y)] == by.y;
    }

    // Whether the pixel's own face gives its weights back, and not another one on whose edge it is too.
    bool fits(const Displacements& d, int x, int y) {
        const PixelCoord& coord = map_.at(x, y);
        const ExactFace& face = rows_.bins().face(coord.face);
        const GridPoint p = position(d, kPixelUnits / d.steps, x, y);
        const SideAreas areas = face.at(p);
        return face.area > 0 && areas.hold() && face.weights(coord.face, areas, rows_.bits()) == coord &&
               (areas.hold_strictly() || rows_.find(p) == coord.face);
    }

    // Tries the grid points around the nearest one.
    bool search(Displacements& d, int x, int y) {
        // Weights are off by less than a step each and by 0 together, so a position by less than a step of
        // the longest side.
        const ExactFace& face = rows_.bins().face(map_.at(x, y).face);
        GridPoint side{0, 0};
        for (const GridPoint& other : {GridPoint{face.by, -face.bx}, GridPoint{-face.cy, face.cx},
                                       GridPoint{face.by + face.cy, -face.bx - face.cx}})
            if (extent(other) > extent(side)) side = other;
        const std::int64_t in_steps = std::int64_t{extent(side)} * d.steps / kPixelUnits;
        if (2 * in_steps < std::int64_t{1} << rows_.bits()) return false;
        const std::int64_t reach = (in_steps >> rows_.bits()) + 1;
        const GridPoint middle = nearest(d.steps, x, y);
        const auto at = [&](int ox, int oy) {
            return set(d, x, y, {middle.x + ox, middle.y + oy}) && fits(d, x, y);
        };
        const int rings = static_cast<int>(std::min(reach, kFarthestSteps));
        for (int ring = 1; ring <= rings; ++ring)
            for (int oy = -ring; oy <= ring; ++oy)
                for (int ox = -ring; ox <= ring; ++ox)
                    if (std::max(std::abs(ox), std::abs(oy)) == ring && at(ox, oy)) return true;
        // Farther away they are in a narrow strip along the side.
        const bool flat = std::abs(side.x) >= std::abs(side.y);
        const int along = static_cast<int>(std::min(reach, kFarthestAlong));
        for (int k = rings + 1; k <= along; ++k)
            for (const int way : {k, -k}) {
                const double across = flat ? double(side.y) / side.x * way : double(side.x) / side.y * way;
                for (int off = -1; off <= 1; ++off) {
                    const int beside = static_cast<int>(std::lround(across)) + off;
                    if (flat ? at(way, beside) : at(beside, way)) return true;
                }
            }
        return false;
    }
    static std::int32_t extent(GridPoint side) { return std::max(std::abs(side.x), std::abs(side.y)); }

    const PixelMap& map_;
    const Displacements* made_of_;
    Rows rows_;
    Displacements found_;
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
        Rows::Scratch scratch(displacements.width, precision);
        for (int y = first; y < last; ++y) {
            if (displacements.row_begin(y) > lost || rows.too_many_tries()) return;
            const int x = rows.locate(displacements, y, scratch, located.map.row(y));
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

std::optional<Displacements> displacements_of(const BaseMesh& mesh, const PixelMap& map,
                                              const Displacements* made_of) {
    if (map.empty() || std::any_of(map.begin(), map.end(), [&](const PixelCoord& c) {
            return c.face != kNone && c.face >= mesh.faces.size();
        }))
        return std::nullopt;
    try {
        Inverse inverse(mesh, map, made_of);
        for (const int steps : {8, 16, 32})
            if (inverse.find(steps)) return std::move(inverse).found();
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::kUnsupported) throw;  // else a mesh that locate_map() refuses
    }
    return std::nullopt;
}

}  // namespace imgmesh
