// Meshes of tiles as one mesh.
#pragma once

#include <map>
#include <utility>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Joins tiles one by one, so that none of them must be kept. Vertices on sides that tiles share become one,
/// as neighbours have the same ones there.
class TileJoiner {
  public:
    /// Adds a tile whose mesh spans the rectangle from (0, 0) to `far` in its own coordinates, and which lies
    /// at `corner` in the whole. All tiles have one unit. Throws Error(kBadFile) if it has other features
    /// than the first one.
    void add(const BaseMesh& mesh, const Vec2f& corner, const Vec2f& far);
    BaseMesh take() { return std::move(mesh_); }

  private:
    BaseMesh mesh_;
    std::map<std::pair<float, float>, Id> on_sides_;
};

}  // namespace imgmesh
