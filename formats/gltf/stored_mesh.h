// A mesh exactly as a container stores it, and its way to and from a BaseMesh.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

class Findings;

/// Which attributes a mesh has beside its positions.
struct StoredLayout {
    bool color = true;
    bool hdr = false;          ///< colours without an upper bound
    std::size_t channels = 0;  ///< channels beside the colour
    bool texture = false;      ///< coordinates in a texture
    bool operator==(const StoredLayout&) const = default;
};

/// Positions are (x, -y, 0) [pixels], colours linear RGB and alpha as 16-bit codes. Parallel arrays, but
/// those of attributes that are not there are empty.
struct StoredMesh {
    std::vector<std::array<float, 3>> position;
    std::vector<std::array<std::uint16_t, 4>> color;
    std::vector<Face> faces;
    std::vector<std::array<float, 3>> hdr;  ///< linear RGB; `color` is then what of it is within [0, 1]
    std::vector<std::vector<float>> channels;
    std::vector<std::array<float, 2>> texcoord;  ///< of viewers alone

    StoredLayout layout() const { return {!color.empty(), !hdr.empty(), channels.size(), !texcoord.empty()}; }

    bool operator==(const StoredMesh&) const = default;
};

/// A position's coordinates lie strictly between - and + this [pixels], so that an extent is less than 2^23
/// steps of kPositionStep: Draco quantises with floor(x + 0.5) in floats, which is exact up to there.
inline constexpr int kMaxCoordinate = 131072;

/// L*u*v* features as linear colour, others as they are, y turned up. Throws Error(kInternal) for a mesh that
/// a container cannot hold without loss: no faces, other features than `layout` has (which are all but the
/// texture), an index out of range, a
/// position off kPositionStep, a face without area, a value that is not finite.
StoredMesh stored_from_base(const BaseMesh& mesh, const StoredLayout& layout = {});
/// The inverse. Errors: indices, positions, colours, channels or faces that are not as they must be; with
/// collecting findings the result is of use only where there are none.
BaseMesh base_from_stored(const StoredMesh& mesh, Findings& findings);
BaseMesh base_from_stored(const StoredMesh& mesh);  ///< strict findings

/// Hex SHA-256 over the indices (uint32) and then the positions (three float32 a vertex), little endian.
std::string topology_hash(const StoredMesh& mesh);

/// Where each face of one mesh is in another: face f is `face[f]` there, and its corner c is corner
/// (c + shift[f]) % 3 there.
struct FaceMatch {
    std::vector<Id> face;
    std::vector<std::uint8_t> shift;
};

/// Matches meshes that differ by the order of vertices and faces and the rotation of corners. Faces are told
/// apart by the positions, colours and channels of their corners, not by vertex, since vertices may coincide
/// and Draco may split them. Throws Error(kInternal) where they differ otherwise. O(F log F).
FaceMatch match_faces(const StoredMesh& from, const StoredMesh& to);

/// Rewrites a pixel map of the mesh `from` for the mesh `to` of match_faces(from, to). Exact, as all weights
/// are multiples of kHalfWeightStep or kFloatWeightStep.
void remap_pixels(const FaceMatch& match, PixelMap& map);

}  // namespace imgmesh
