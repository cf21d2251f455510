// A base mesh in pieces, as a plain glTF asset for modelling programs.
#pragma once

#include <span>
#include <string>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Writes a .glb: one mesh with one primitive for each region that has faces, in order of regions, each with
/// vertices and a material of its own, named region-<number>, so that programs let a user pick it. Positions,
/// colours and the node as in a container (docs/format.md), neither Draco nor our extension.
///
/// region_of_face: of each face, kNone to leave it out. Atomic. Throws Error: kBadArgument for another
/// extension; kUnsupported where no face is left or the file would be over 2 GiB; kIo where it cannot be
/// written.
void write_region_mesh(const std::string& path, const BaseMesh& mesh, std::span<const Id> region_of_face,
                       const SourceInfo& source, const std::string& generator, bool overwrite);

}  // namespace imgmesh
