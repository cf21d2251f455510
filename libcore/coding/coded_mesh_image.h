// A coded picture as a mesh for other programs.
#pragma once

#include "libcore/coding/coded_stream.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh::coding {

/// Returns the mesh of a coded picture with its trivial pixel map, as one level. Colours are divided by
/// alpha, which is a channel of its own; vertices that are not seen take the colour beside them. Programs
/// that mix colours in linear light show it a little differently than draw_coded(), which mixes them as
/// encoded. Takes 12 bytes of memory a pixel.
MeshImage mesh_image_from_coded(const StreamContent& content);

}  // namespace imgmesh::coding
