// The class Mesh of JavaScript.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/container/container.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/pipeline/build.h"

namespace imgmesh::web {

/// A mesh image, and what is known of its build.
struct MeshValue {
    MeshImage mesh_image;
    std::optional<BuildReport> report = {};  ///< of a mesh that was built here
    std::vector<std::string> warnings = {};  ///< by that build
    // How it is saved unless another way is asked for: as the container was from which it comes.
    Texture texture = {};
    ExrMetadata metadata = {};
    DracoMode draco = DracoMode::kEdgebreaker;
    LayerLayout layers = LayerLayout::kExr;

    const Level& level(int index) const;  ///< Throws Error(kBadArgument) for a level that does not exist.
};
using MeshPointer = std::shared_ptr<MeshValue>;

}  // namespace imgmesh::web
