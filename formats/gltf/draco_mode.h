// How a mesh is compressed in a container.
#pragma once

namespace imgmesh {

/// Both Draco modes lose nothing.
enum class DracoMode {
    kEdgebreaker,  ///< about half the size of kSequential; reorders vertices and faces
    kSequential,   ///< keeps the order of vertices and faces
    kOff           ///< no compression
};

}  // namespace imgmesh
