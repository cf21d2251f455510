// Meshes as Draco bitstreams (KHR_draco_mesh_compression): lossless for positions on kPositionStep.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/gltf/draco_mode.h"
#include "formats/gltf/stored_mesh.h"

namespace imgmesh {

class Findings;

/// The unique ids of the attributes in a bitstream.
struct DracoAttributeIds {
    std::uint32_t position = 0;
    std::optional<std::uint32_t> color = 1, hdr = {};
    std::vector<std::uint32_t> channels = {};
    std::optional<std::uint32_t> texcoord = {};
    bool operator==(const DracoAttributeIds&) const = default;
};
/// Returns the ids that encode_draco_mesh() gives to the attributes of such a mesh.
DracoAttributeIds draco_ids(const StoredLayout& layout);

/// A bitstream, and the mesh that every decoder gets from it. That mesh counts.
struct DracoMesh {
    std::vector<std::uint8_t> bytes;
    StoredMesh decoded;
};

/// Encodes a mesh with faces, attributes without holes, no face of area 0, and positions on kPositionStep
/// with z = 0. `mode` is not kOff. kSequential keeps all order. kEdgebreaker gives about half the size, but
/// reorders vertices and faces, rotates corners, splits non-manifold vertices and drops vertices without a
/// face. Nothing else is lost. Throws Error(kInternal) if Draco fails.
DracoMesh encode_draco_mesh(const StoredMesh& mesh, DracoMode mode);

/// Returns how it was made. Throws FindingError unless it is a mesh of the current bitstream version.
DracoMode draco_mode(std::span<const std::uint8_t> bytes);

/// Decodes a mesh with known numbers of vertices and faces and known attributes. Safe for any bytes: the
/// sizes in the bitstream are compared with `vertices` and `faces` before memory is taken. Indices are in
/// range; positions and colours are not checked. Throws FindingError.
StoredMesh decode_draco_mesh(std::span<const std::uint8_t> bytes, const DracoAttributeIds& ids,
                             std::uint64_t vertices, std::uint64_t faces, Findings& findings);
StoredMesh decode_draco_mesh(std::span<const std::uint8_t> bytes, const DracoAttributeIds& ids,
                             std::uint64_t vertices, std::uint64_t faces);  ///< strict findings

}  // namespace imgmesh
