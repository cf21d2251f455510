// The files by which the bench talks to other simplifiers: numbers as they lie in memory, little endian.
//
// features  "IMFEAT1\n", uint32 width, uint32 height, then float32 L*, u*, v* a pixel, rows from top to
// bottom mesh      "IMMESH1\n", uint32 vertices, uint32 faces, then float32 x, y, L*, u*, v* a vertex
// [pixels], uint32 three
//           corners a face, of either orientation
#pragma once

#include <string>

#include "libcore/image/image.h"
#include "libcore/mesh/base_mesh.h"

namespace imgmesh::bench {

/// Throws Error(kIo).
void write_features(const std::string& path, const FeatureImage& feature);
/// Throws Error: kIo, kBadFile.
FeatureImage read_features(const std::string& path);
void write_mesh(const std::string& path, const BaseMesh& mesh);
/// Positions come back on kPositionStep and faces in our orientation; those without area are left out. Throws
/// Error: kIo, kBadFile.
BaseMesh read_mesh(const std::string& path);

}  // namespace imgmesh::bench
