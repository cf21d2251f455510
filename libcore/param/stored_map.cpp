#include "libcore/param/stored_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/mesh/grid_area.h"
#include "libcore/mesh/locate_map.h"
#include "libcore/mesh/mapped_position.h"

namespace imgmesh {
namespace {

// Rows of one block: enough work to be worth handing over, few enough for every thread to get some.
constexpr int kGrainRows = 16;

// Whether the four triangles of a cell keep their area. Those with a corner outside a mask are NaN and do not
// count.
bool keeps_area(const Vec2d& tl, const Vec2d& tr, const Vec2d& bl, const Vec2d& br) {
    for (const double area :
         {grid_area2(tl, tr, br), grid_area2(tl, br, bl), grid_area2(tl, tr, bl), grid_area2(tr, br, bl)})
        if (area < kLeastStoredArea) return false;
    return true;
}

void set_positions(const BaseMesh& mesh, const PixelMap& map, int y, std::vector<Vec2d>& row) {
    for (int x = 0; x < map.width; ++x) {
        const PixelCoord& coord = map.at(x, y);
        row[as_index(x)] = coord.face == kNone ? Vec2d::Constant(std::numeric_limits<double>::quiet_NaN())
                                               : mapped_position(mesh.faces, mesh.position, coord);
    }
}

bool keeps_areas(const BaseMesh& mesh, const PixelMap& map) {
    std::atomic<bool> kept = true;
    parallel_blocks(0, map.height, kGrainRows, [&](int first, int last) {
        std::vector<Vec2d> above(as_index(map.width)), row(above);
        set_positions(mesh, map, std::max(0, first - 1), row);
        for (int y = std::max(1, first); y < last && kept; ++y) {
            std::swap(above, row);
            set_positions(mesh, map, y, row);
            for (std::size_t x = 0; x + 1 < row.size(); ++x)
                if (!keeps_area(above[x], above[x + 1], row[x], row[x + 1])) kept = false;
        }
    });
    return kept;
}

// Whether the map has displacements, and they fold no triangle. In halves, positions in large faces are known
// to less than the grid, so these need not be the displacements of which the map was made.
bool unfolds(const BaseMesh& mesh, const PixelMap& map, const Displacements& made_of) {
    const std::optional<Displacements> found = displacements_of(mesh, map, &made_of);
    if (!found) return false;
    const Displacements& d = *found;
    if (d.steps == made_of.steps && d.dx == made_of.dx && d.dy == made_of.dy) return true;
    struct Point {
        std::int64_t x, y;
        bool inside;
    };
    const auto at = [&](int x, int y) {
        const std::size_t i = d.index(x, y);
        return Point{std::int64_t{x} * d.steps + d.dx[i], std::int64_t{y} * d.steps + d.dy[i],
                     d.inside.contains(i)};
    };
    const auto folds = [](const Point& a, const Point& b, const Point& c) {
        return a.inside && b.inside && c.inside && (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) <= 0;
    };
    std::atomic<bool> folded = false;
    parallel_blocks(0, d.height - 1, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last && !folded; ++y)
            for (int x = 0; x + 1 < d.width; ++x) {
                const Point tl = at(x, y), tr = at(x + 1, y), bl = at(x, y + 1), br = at(x + 1, y + 1);
                if (folds(tl, tr, br) || folds(tl, br, bl) || folds(tl, tr, bl) || folds(tr, br, bl))
                    folded = true;
            }
    });
    return !folded;
}

}  // namespace

PixelMap stored_map(const BaseMesh& mesh, const Displacements& places,
                    std::optional<WeightPrecision> wanted) {
    const auto with = [&](WeightPrecision precision) {
        LocatedMap located = locate_map(mesh, places, precision);
        if (located.lost) throw Error(ErrorKind::kInternal, "a pixel lies outside the mesh");
        return std::move(located.map);
    };
    if (wanted != WeightPrecision::kFloat) {
        PixelMap map = with(WeightPrecision::kHalf);
        if (keeps_areas(mesh, map) && (wanted || unfolds(mesh, map, places))) return map;
        if (wanted)
            throw Error(
                ErrorKind::kUnsupported,
                "weights of half precision are too coarse for faces this large, those of float are not");
    }
    return with(WeightPrecision::kFloat);
}

}  // namespace imgmesh
