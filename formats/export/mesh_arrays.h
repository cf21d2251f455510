// A level as arrays for numpy. Target imgmesh::pictures.
#pragma once

#include <string>
#include <vector>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Returns the colours of a mesh's vertices, size V * 3, interleaved: sRGB from 0 to 1, of an HDR image
/// linear RGB. Empty for a mesh without colour.
std::vector<float> vertex_colors(const BaseMesh& mesh, const SourceInfo& source);

/// Writes a level as an .npz (write_npz()) of W x H pixels, V vertices of C features and F faces:
///
/// vertices       V x 2, float32  [pixels]
/// faces          F x 3, uint32
/// features       V x C, float32: colour as L*u*v*, and other channels in their own unit
/// colors         V x 3, float32: vertex_colors(), if there is a colour
/// face_ids       H x W, uint32; kNone outside the mask
/// barycentrics   H x W x 2, float32: weights of the second and third corner
/// visits         H x W, uint32, of level 0 if there are any
/// channel_names  UTF-8: the image's channels that the features come from
///
/// Takes 12 bytes of memory for each pixel. Throws as write_npz() does.
void write_mesh_arrays(const std::string& path, const MeshImage& mesh_image, std::size_t level,
                       bool overwrite);

}  // namespace imgmesh
