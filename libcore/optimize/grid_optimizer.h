// The optimiser of meshes: connectivity, positions on a grid and colours for the least squared error of a
// drawing with a given number of vertices.
#pragma once

#include <cstddef>
#include <memory>

#include "libcore/base/progress.h"
#include "libcore/optimize/face_rules.h"
#include "libcore/optimize/placed_mesh.h"
#include "libcore/optimize/row_sums.h"

namespace imgmesh {

struct GridSchedule;
class GridState;

struct OptimizeParams {
    int effort = 3;              ///< 1 to 5; each takes up to four times as long as the one before
    int step = kPlacesPerPixel;  ///< of the grid of places
    bool keep_faces = false;  ///< boundaries keep their number of vertices, so that the number of faces stays
    bool newton_steps = false;             ///< moves begin with a Gauss-Newton step
    int last_settles = 1;                  ///< flips, moves and colours after vertices were removed
    int longest_step = 8, first_step = 1;  ///< of a vertex by its pattern [grid steps]; at most 255
    FaceLimits limits = {};
    double shape_weight = 0;  ///< of the sum of 1/q - 1 over faces, in mean squared errors of a face; >= 0
};

/// Keeps the mesh, so that the number of vertices can change between one optimisation and the next. Works on
/// all threads; the result has the same bits for any number of them and on every machine.
///
/// Steps: moves of vertices, each with its colour solved; flips; all colours by least squares; exchanges:
/// vertices inserted where they gain most, and as many removed where they cost least; annealing.
/// Source and figures: docs/decisions/0043-optimising-on-a-grid.md.
class GridOptimizer {
  public:
    /// Keeps a reference to `sums`. The mesh has their size.
    GridOptimizer(const RowSums& sums, const PlacedMesh& start, const OptimizeParams& params);
    ~GridOptimizer();

    /// Inserts vertices where they gain most, or removes them where they cost least, and lets the mesh
    /// settle: tens of milliseconds for a change of a few percent. A grid without room gets fewer.
    void set_vertex_count(std::size_t vertices);
    /// Optimises with this number of vertices. The cost does not rise.
    void optimize();
    /// touch_up_schedule() suits after set_vertex_count().
    void optimize(const GridSchedule& schedule, const Progress& progress = {});

    std::size_t vertices() const;
    double cost() const;           ///< squared error and shapes
    double squared_error() const;  ///< over all pixels and channels
    PlacedMesh result() const;

  private:
    void settle(int times);
    void remove_surplus(std::size_t vertices);
    void exchange(std::size_t vertices, double share, int settles);
    void anneal(const GridSchedule& schedule, const Progress& progress, double begin, double end);

    OptimizeParams params_;
    std::size_t border_ = 0;  // vertices of the boundary, with keep_faces
    std::unique_ptr<GridState> state_;
};

/// Returns a regular mesh of about so many vertices, at least the corners, without colours.
PlacedMesh regular_mesh(const RowSums& sums, int step, std::size_t vertices);

}  // namespace imgmesh
