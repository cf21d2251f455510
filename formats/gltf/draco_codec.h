// Draco itself, behind what draco_mesh checks and chooses. Private to this folder; the page has another half
// (web/ports/draco_codec.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/gltf/draco_mesh.h"

namespace imgmesh {

/// The grid on which positions lie: 2^bits - 1 steps from `origin` on give `range`.
struct DracoGrid {
    int bits;
    std::array<float, 3> origin;
    float range;
};

/// How Draco predicts values, where its usual choice is not the smallest.
struct DracoPredictions {
    bool parallelogram = false;  ///< positions by one parallelogram, not the mean of several
    bool plain_color = false;    ///< colours not at all
};
/// Whether draco_encode() follows them. Otherwise it always takes Draco's usual choice.
bool draco_takes_predictions();

/// How many attributes these are.
int attribute_count(const DracoAttributeIds& ids);

/// Encodes as encode_draco_mesh() does. Throws Error(kInternal) if Draco fails.
std::vector<std::uint8_t> draco_encode(const StoredMesh& mesh, const DracoAttributeIds& ids, DracoMode mode,
                                       const DracoGrid& grid, const DracoPredictions& predictions);

/// Decodes a mesh whose header has been checked. Indices are in range. Throws FindingError for other
/// attributes and broken data.
StoredMesh draco_decode(std::span<const std::uint8_t> bytes, const DracoAttributeIds& ids, DracoMode mode,
                        Findings& findings);

}  // namespace imgmesh
