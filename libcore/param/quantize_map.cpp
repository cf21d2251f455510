#include "libcore/param/quantize_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "libcore/base/parallel.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/mesh/grid_area.h"
#include "libcore/mesh/mapped_position.h"
#include "libcore/mesh/weight_grid.h"

namespace imgmesh {
namespace {

// Rows of one block: enough work to be worth handing over, few enough for every thread to get some.
constexpr int kGrainRows = 16;

// Few cells need repair: one in a thousand in photographs with few vertices, none at 1 %. Where whole regions
// fold, the faces are too large, and trying each cell would take minutes: beyond one cell in 64, and 64 more,
// the map is given up.
constexpr std::size_t kFewCells = 64, kCellsPerRepair = 64;
// Passes over the bad cells, at most.
constexpr int kPasses = 40;
// Distances of the candidates, doubled from a fraction of the rounding error up to most of a pixel, in each
// of so many directions.
constexpr double kNearest = 0.01, kFarthest = 1.0;
constexpr int kDirections = 8;

// The least of the four triangles of a cell; differences of stored positions are exact. Triangles with a
// corner outside a mask are NaN and do not count.
double cell_area2(const Vec2d& tl, const Vec2d& tr, const Vec2d& bl, const Vec2d& br) {
    double least = std::numeric_limits<double>::infinity();
    for (const double area :
         {grid_area2(tl, tr, br), grid_area2(tl, br, bl), grid_area2(tl, tr, bl), grid_area2(tr, br, bl)})
        if (area < least) least = area;
    return least;
}

class Storing {
  public:
    Storing(const BaseMesh& mesh, const PixelEmbedding& pixels, const std::vector<FaceField>& fields,
            const std::vector<Face>& neighbors, WeightPrecision precision)
        : mesh_(mesh),
          pixels_(pixels),
          fields_(fields),
          neighbors_(neighbors),
          steps_(weight_steps(precision)),
          map_(pixels.width, pixels.height, parallel_vector<PixelCoord>(pixels.face.size()), precision) {}

    std::optional<PixelMap> run() {
        parallel_blocks(0, map_.height, kGrainRows, [&](int first, int last) {
            for (int y = first; y < last; ++y)
                for (int x = 0; x < map_.width; ++x)
                    if (const Id face = pixels_.face[pixels_.index(x, y)]; face != kNone)
                        map_.at(x, y) = rounded(face, pixels_.image_of(x, y).cast<double>());
        });
        const std::size_t repairable = kFewCells + map_.size() / kCellsPerRepair;
        int idle = 0;  // passes without a move; odd and even ones try different places
        for (int pass = 0; pass < kPasses && idle < 2; ++pass) {
            const std::vector<std::pair<int, int>> cells = bad_cells();
            if (cells.empty()) return std::move(map_);
            if (cells.size() > repairable) return std::nullopt;
            bool moved = false;
            for (const auto& [x, y] : cells) moved |= repair(x, y, pass);
            idle = moved ? 0 : idle + 1;
        }
        return std::nullopt;
    }

  private:
    Vec2d position(const PixelCoord& coord) const {
        if (coord.face == kNone) return Vec2d::Constant(std::numeric_limits<double>::quiet_NaN());
        return mapped_position(mesh_.faces, mesh_.position, coord);
    }
    Vec2d position(int x, int y) const { return position(map_.at(x, y)); }

    // Returns the grid point of `face` nearest to p, by largest remainders, so that the three weights sum to
    // one exactly.
    PixelCoord rounded(Id face, const Vec2d& p) const {
        const auto [a, b, c] = mesh_.faces[face];
        const Vec2d pa = mesh_.position[a].cast<double>(), ab = mesh_.position[b].cast<double>() - pa,
                    ac = mesh_.position[c].cast<double>() - pa, d = p - pa;
        const double det = ab.x() * ac.y() - ab.y() * ac.x();
        std::array<double, 3> w{};
        w[1] = std::clamp((d.x() * ac.y() - d.y() * ac.x()) / det, 0.0, 1.0);
        w[2] = std::clamp((ab.x() * d.y() - ab.y() * d.x()) / det, 0.0, 1.0);
        w[0] = std::max(0.0, 1 - w[1] - w[2]);
        return on_weight_grid(face, w, steps_);
    }

    std::vector<std::pair<int, int>> bad_cells() const {
        const int rows = std::max(0, map_.height - 1);
        std::vector<std::vector<std::pair<int, int>>> found(as_index(rows));
        parallel_blocks(0, rows, kGrainRows, [&](int first, int last) {
            for (int y = first; y < last; ++y) {
                Vec2d tl = position(0, y), bl = position(0, y + 1);
                for (int x = 0; x + 1 < map_.width; ++x) {
                    const Vec2d tr = position(x + 1, y), br = position(x + 1, y + 1);
                    if (cell_area2(tl, tr, bl, br) < kLeastStoredArea) found[as_index(y)].emplace_back(x, y);
                    tl = tr;
                    bl = br;
                }
            }
        });
        std::vector<std::pair<int, int>> all;
        for (const auto& row : found) all.insert(all.end(), row.begin(), row.end());
        return all;
    }

    // Returns the least triangle of the up to four cells around pixel (x, y).
    double area_around(int x, int y) const {
        double least = std::numeric_limits<double>::infinity();
        for (int cy = std::max(0, y - 1); cy <= std::min(y, map_.height - 2); ++cy)
            for (int cx = std::max(0, x - 1); cx <= std::min(x, map_.width - 2); ++cx)
                least = std::min(least, cell_area2(position(cx, cy), position(cx + 1, cy),
                                                   position(cx, cy + 1), position(cx + 1, cy + 1)));
        return least;
    }

    // Moves each pixel of a cell to the candidate near its place that leaves the fattest triangles around it.
    // Returns whether any pixel moved.
    bool repair(int cell_x, int cell_y, int pass) {
        bool moved = false;
        for (int corner = 0; corner < 4; ++corner) {
            const int x = cell_x + corner % 2, y = cell_y + corner / 2;
            PixelCoord& coord = map_.at(x, y);
            if (coord.face == kNone) continue;
            PixelCoord best = coord;
            double best_area = area_around(x, y);
            const Vec2d center = pass % 2 ? position(coord) : pixels_.image_of(x, y).cast<double>();
            for (double radius = kNearest; radius < kFarthest; radius *= 2)
                for (int direction = 0; direction < kDirections && best_area < 2 * kLeastStoredArea;
                     ++direction) {
                    const double angle = direction * (2 * std::numbers::pi / kDirections);
                    Vec2d q = center + radius * Vec2d(std::cos(angle), std::sin(angle));
                    if (pixels_.pinned_x(x, y)) q.x() = x;
                    if (pixels_.pinned_y(x, y)) q.y() = y;
                    q = q.cwiseMax(0.0).cwiseMin(Vec2d(map_.width - 1, map_.height - 1));
                    coord = rounded(locate_face(q.cast<float>(), coord.face, fields_, neighbors_), q);
                    const double area = area_around(x, y);
                    if (area > best_area) {
                        best_area = area;
                        best = coord;
                        moved = true;
                    }
                }
            coord = best;
        }
        return moved;
    }

    const BaseMesh& mesh_;
    const PixelEmbedding& pixels_;
    const std::vector<FaceField>& fields_;
    const std::vector<Face>& neighbors_;
    double steps_;
    PixelMap map_;
};

}  // namespace

std::optional<PixelMap> quantize_map(const BaseMesh& mesh, const PixelEmbedding& pixels,
                                     const std::vector<FaceField>& fields, const std::vector<Face>& neighbors,
                                     WeightPrecision precision) {
    return Storing(mesh, pixels, fields, neighbors, precision).run();
}

}  // namespace imgmesh
