// Pixel maps for tests of segmentation, which depends on the pixels that share a face and not on the mesh.
#pragma once

#include <utility>
#include <vector>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh::test {

/// All weights are a third, except for pixels outside.
inline PixelMap map_of_faces(int width, int height, const std::vector<Id>& faces) {
    PixelMap map{width, height, {}, WeightPrecision::kFloat};
    for (const Id face : faces)
        map.values.push_back(face == kNone ? PixelCoord{} : PixelCoord{face, 1.0f / 3, 1.0f / 3});
    return map;
}

inline Level level_of(PixelMap map) {
    Level level;
    level.map = std::move(map);
    return level;
}

}  // namespace imgmesh::test
