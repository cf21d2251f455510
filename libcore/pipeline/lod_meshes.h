// Meshes of one collapse at numbers of vertices that are not known beforehand.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "libcore/base/progress.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh {

/// One collapse. It keeps meshes just above each requested number of vertices, so that a later request may be
/// a little finer. For a much finer one it starts again.
class LodMeshes {
  public:
    /// params  of a new collapse, for the number of vertices that it is to reach
    /// Both grid and progress must outlive this object.
    LodMeshes(const GridMesh& grid, std::function<SimplifyParams(std::int64_t)> params,
              const Progress& progress);

    /// Returns a mesh with at most `vertices` (>= 4) and at most about 1.5 % fewer, or the coarsest; keeps up
    /// to a third finer ones. Without `lods` it has exactly as many, and none is kept.
    SimplifyResult mesh(std::int64_t vertices, bool lods);

    /// Returns how often the collapse has started.
    int runs() const { return runs_; }

  private:
    const GridMesh& grid_;
    std::function<SimplifyParams(std::int64_t)> params_;
    const Progress& progress_;
    std::optional<SimplifyRun> run_;
    std::int64_t reached_ = 0;          // vertices that the present run has reached
    std::vector<SimplifyResult> kept_;  // finest first
    int runs_ = 0;
};

}  // namespace imgmesh
