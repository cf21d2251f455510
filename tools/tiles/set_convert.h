// imgmesh-convert on tile sets.
#pragma once

#include <string>

#include "formats/container/container.h"
#include "tools/common/tool_main.h"

namespace imgmesh {

struct SetConvertOptions {
    std::string input, output;
    int level = 0;
    bool gradient = false;       ///< of an .svg's triangles
    ContainerOptions container;  ///< how a .glb or .gltf is written; always without layers
    ContainerLimits limits;
};

/// Writes all tiles of a level as one mesh: a .glb or .gltf without a pixel map, .ply, .obj or .svg. One unit
/// is a pixel of the level. Returns the report's members.
Report convert_set(const SetConvertOptions& options, Context& context);

}  // namespace imgmesh
