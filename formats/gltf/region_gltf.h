// Writes a base mesh in pieces, for modelling programs.
#pragma once

#include <span>
#include <string>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Writes a .glb with one mesh, which has a primitive for each region with faces, in order of regions. Each
/// has vertices of its own and a material named region-<number>, so that modelling programs let a user pick
/// it. Positions, colours and the node are those of a container (docs/format.md), without Draco and without
/// the extension IMGMESH_pixel_map.
///
/// region_of_face  the region of every face, such as from region_of_faces(); kNone leaves the face out
/// source          of the MeshImage
/// generator       the program that writes, such as "example 1.0"
///
/// The file appears whole or not at all. Takes O(vertices + faces) time. Throws Error: kBadArgument for
/// another extension; kUnsupported if no face is left and for a file over 2 GiB; kIo if it cannot be written,
/// or exists and `overwrite` is false.
void write_region_mesh(const std::string& path, const BaseMesh& mesh, std::span<const Id> region_of_face,
                       const SourceInfo& source, const std::string& generator, bool overwrite);

}  // namespace imgmesh
