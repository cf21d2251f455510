// The connected parts of a mesh, and their rigid motions.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// The parts of a mesh that are connected by faces of positive area. A vertex without one is a part.
class MeshParts {
  public:
    explicit MeshParts(const BaseMesh& mesh);

    std::size_t count() const { return count_; }
    Id of(Id vertex) const { return part_[vertex]; }

    /// Returns for every vertex whether its part has one of `vertices`.
    std::vector<bool> vertices_with(const std::vector<Id>& vertices) const;

    /// Moves each part that has a fixed vertex rigidly, so that its fixed vertices are nearest to their
    /// targets, and then puts these there.
    ///
    /// rest   of all vertices [pixels]
    /// place  of all vertices; overwritten for such parts
    void move_rigidly(const std::vector<Vec2d>& rest, const std::vector<Id>& fixed,
                      const std::vector<Vec2d>& target, std::vector<Vec2d>& place) const;

  private:
    std::vector<Id> part_;
    Id count_ = 0;
};

}  // namespace imgmesh
