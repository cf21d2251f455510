// A part of a mesh with its boundary first, as engines take a deformable sprite.
#pragma once

#include <cstddef>
#include <vector>

#include "libcore/base/index.h"

namespace imgmesh {

/// A part of a mesh that is a disc: its boundary is one closed walk.
struct DiscPart {
    /// For each of its vertices the mesh's vertex that it is a copy of. The first `hull` are the boundary,
    /// counter-clockwise on screen; the others lie inside.
    std::vector<Id> vertex;
    std::size_t hull = 0;
    std::vector<Face> faces;  ///< indices into `vertex`; orientation and order of the mesh's
};

}  // namespace imgmesh
