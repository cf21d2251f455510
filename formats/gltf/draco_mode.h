// How a mesh is compressed in a container.
#pragma once

namespace imgmesh {

/// kSequential keeps the order of vertices and faces; kEdgebreaker is about half the size and reorders both.
enum class DracoMode { kEdgebreaker, kSequential, kOff };

}  // namespace imgmesh
