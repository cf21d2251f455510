// Meshes of a collapse at numbers of vertices that are not known beforehand.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "libcore/base/progress.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh {

/// One collapse, which leaves copies of the meshes just above each that was asked for, so that the next can
/// be a little finer as well. For a much finer one it begins anew.
class LodMeshes {
  public:
    /// params  of a collapse that begins, for the number of vertices that it is to reach
    /// Both grid and progress must live as long.
    LodMeshes(const GridMesh& grid, std::function<SimplifyParams(std::int64_t)> params,
              const Progress& progress);

    /// The mesh with at most `vertices` (>= 4) and about 1.5 % fewer at the least, or the coarsest there is;
    /// further ones up to a third larger are kept. Without `lods` exactly as many, and none is kept.
    SimplifyResult mesh(std::int64_t vertices, bool lods);

    /// How often the collapse has begun.
    int runs() const { return runs_; }

  private:
    const GridMesh& grid_;
    std::function<SimplifyParams(std::int64_t)> params_;
    const Progress& progress_;
    std::optional<SimplifyRun> run_;
    std::int64_t reached_ = 0;          // vertices at which the run stands
    std::vector<SimplifyResult> kept_;  // finest first
    int runs_ = 0;
};

}  // namespace imgmesh
