// A base mesh in pieces, as a glTF asset for modelling programs.
#pragma once

#include <span>
#include <string>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Writes a .glb: one mesh with one primitive for each region that has faces, in order of regions. Each has
/// vertices and a material of its own, named region-<number>, so that users can select it in programs.
/// Positions, colours and the node are as in a container (docs/format.md), without Draco and without our
/// extension.
///
/// region_of_face: of each face, kNone to leave it out. Atomic. Throws Error: kBadArgument for another
/// extension; kUnsupported if no face is left or the file would exceed 2 GiB; kIo if it cannot be written.
void write_region_mesh(const std::string& path, const BaseMesh& mesh, std::span<const Id> region_of_face,
                       const SourceInfo& source, const std::string& generator, bool overwrite);

}  // namespace imgmesh
