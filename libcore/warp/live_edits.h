// Solves edits again and again as a hand changes them.
#pragma once

#include <memory>

#include "libcore/mesh/mesh_image.h"
#include "libcore/warp/solve_edits.h"
#include "libcore/warp/warp_edits.h"

namespace imgmesh {

/// Keeps what the last call of solve() or follow() has factorised, and what it has found, so edits that have
/// not changed cost nothing, and a drag costs what one solve() of ArapSolver or InjectiveSolver takes.
class LiveEdits {
  public:
    /// mesh_image  must outlive this object and stay as it is
    explicit LiveEdits(const MeshImage& mesh_image);
    ~LiveEdits();
    LiveEdits(LiveEdits&&) noexcept;
    LiveEdits& operator=(LiveEdits&&) noexcept;

    /// As edit_solution(), to the bit. It does not depend on earlier calls.
    EditSolution solve(const WarpEdits& edits);
    /// Solves for the next picture of a drag: iterations begin where the last call ended and are few, so
    /// vertices may lag behind by a little. Calling it again with the same edits brings them nearer.
    EditSolution follow(const WarpEdits& edits);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace imgmesh
