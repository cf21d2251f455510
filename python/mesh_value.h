// imgmesh.Mesh and its levels.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/container/container.h"
#include "libcore/pipeline/build.h"

namespace imgmesh::python {

/// imgmesh.Mesh: what a container holds. Never changes, as arrays show its memory.
struct MeshValue {
    Container container;
    std::optional<BuildReport> report = {};  ///< of a mesh that was built here
    std::vector<std::string> missed = {};    ///< by that build, as missed_targets() tells it

    const MeshImage& mesh_image() const { return container.mesh_image; }
};
using MeshPointer = std::shared_ptr<MeshValue>;

/// imgmesh.Level.
struct LevelValue {
    std::shared_ptr<const MeshValue> mesh;
    std::size_t index = 0;

    const Level& level() const { return mesh->mesh_image().levels[index]; }
};

/// Throws Error(kBadArgument) unless the mesh has that level, counted from 0.
void check_level(const MeshValue& mesh, int level);

}  // namespace imgmesh::python
