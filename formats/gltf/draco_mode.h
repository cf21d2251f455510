// How a mesh is compressed in a container.
#pragma once

namespace imgmesh {

/// kSequential keeps the order of vertices and faces; kEdgebreaker changes it and halves the size.
enum class DracoMode { kEdgebreaker, kSequential, kOff };

}  // namespace imgmesh
