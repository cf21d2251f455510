// The optimiser of coded meshes: connectivity, positions on the grid and colours for the least squared error
// of a drawing with a given number of vertices.
#pragma once

#include <cstddef>
#include <memory>

#include "libcore/coding/coded_mesh.h"
#include "libcore/coding/row_sums.h"

namespace imgmesh {

struct GridSchedule;
class GridState;

struct OptimizeParams {
    int effort = 3;  ///< 1 to 5; each takes up to four times as long as the one before
};

/// Keeps the mesh, so that the number of vertices can change between one optimisation and the next. Works on
/// one thread; the result has the same bits on every machine.
///
/// Steps: moves of vertices, each with its colour solved; flips; all colours by least squares; exchanges:
/// vertices inserted where they gain most, and as many removed where they cost least; annealing.
/// Source and figures: docs/decisions/0043-optimising-on-a-grid.md.
class GridOptimizer {
  public:
    /// Keeps a reference to `sums`. The mesh has their size and channels; its colours may be empty.
    GridOptimizer(const RowSums& sums, const CodedMesh& start, const OptimizeParams& params);
    ~GridOptimizer();

    /// Inserts vertices where they gain most, or removes them where they cost least, and lets the mesh
    /// settle: tens of milliseconds for a change of a few percent. A grid without room gets fewer.
    void set_vertex_count(std::size_t vertices);
    /// Optimises with this number of vertices. The error does not rise.
    void optimize();
    void optimize(const GridSchedule& schedule);  ///< touch_up_schedule() after set_vertex_count()

    std::size_t vertices() const;
    double squared_error() const;  ///< over all pixels and channels
    CodedMesh result() const;

  private:
    void settle(int times);
    void exchange(double share, int settles);
    void anneal(const GridSchedule& schedule);

    OptimizeParams params_;
    std::unique_ptr<GridState> state_;
};

/// Returns a regular mesh of about so many vertices, at least the corners, without colours.
CodedMesh regular_mesh(const RowSums& sums, int step, std::size_t vertices);

}  // namespace imgmesh
