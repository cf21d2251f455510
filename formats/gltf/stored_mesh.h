// A mesh exactly as a container stores it, and its conversion from and to a BaseMesh.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

class Findings;

/// The attributes that a mesh has beside its positions.
struct StoredLayout {
    bool color = true;
    bool hdr = false;          ///< colours without an upper bound
    std::size_t channels = 0;  ///< auxiliary channels
    bool texture = false;      ///< coordinates in a texture
    /// The channel, from 0, that viewers see as the alpha of the colour; only for stored_from_base().
    std::optional<std::size_t> alpha = {};
    bool operator==(const StoredLayout&) const = default;
};

/// Positions are (x, -y, 0) [pixels], colours linear RGB and alpha as 16-bit codes. The arrays are parallel,
/// but those of missing attributes are empty.
struct StoredMesh {
    std::vector<std::array<float, 3>> position;
    std::vector<std::array<std::uint16_t, 4>> color;
    std::vector<Face> faces;
    std::vector<std::array<float, 3>> hdr;  ///< linear RGB; `color` is then clipped to [0, 1]
    std::vector<std::vector<float>> channels;
    std::vector<std::array<float, 2>> texcoord;  ///< for viewers alone

    StoredLayout layout() const {
        return {!color.empty(), !hdr.empty(), channels.size(), !texcoord.empty(), {}};
    }

    bool operator==(const StoredMesh&) const = default;
};

/// The box around positions; there is at least one.
struct Bounds {
    std::array<float, 3> low{}, high{};
    bool operator==(const Bounds&) const = default;
};
Bounds bounds_of(std::span<const std::array<float, 3>> positions);

/// A position's coordinates lie strictly between - and + this [pixels]. An extent is then less than 2^23
/// steps of kPositionStep, up to which Draco's quantisation, floor(x + 0.5) in floats, is exact.
inline constexpr int kMaxCoordinate = 131072;

/// Stores L*u*v* features as linear colour and others unchanged, with y turned up. Throws Error(kInternal)
/// for a mesh that a container cannot hold without loss: no faces, other features than `layout` has (except
/// the texture), an index out of range, a position off kPositionStep, a face without area, a value that is
/// not finite.
StoredMesh stored_from_base(const BaseMesh& mesh, const StoredLayout& layout = {});
/// The inverse. With `soft`, the colours may have any alpha, as a channel A gives them. Errors are invalid
/// indices, positions, colours, channels or faces. With collecting findings the result is valid only if there
/// are none.
BaseMesh base_from_stored(const StoredMesh& mesh, Findings& findings, bool soft = false);
BaseMesh base_from_stored(const StoredMesh& mesh);  ///< strict findings

/// Returns the hex SHA-256 over the indices (uint32) and then the positions (three float32 a vertex), little
/// endian.
std::string topology_hash(const StoredMesh& mesh);

/// The place of each face of one mesh in another: face f is `face[f]` there, and its corner c is corner (c +
/// shift[f]) % 3 there.
struct FaceMatch {
    std::vector<Id> face;
    std::vector<std::uint8_t> shift;
};

/// Matches meshes that differ by the order of vertices and faces and the rotation of corners. Faces are
/// identified by the positions, colours and channels of their corners, not by vertex numbers, since vertices
/// may coincide and Draco may split them. Throws Error(kInternal) if the meshes differ otherwise. Takes O(F
/// log F) time.
FaceMatch match_faces(const StoredMesh& from, const StoredMesh& to);

/// Rewrites a pixel map of the mesh `from` for the mesh `to` of match_faces(from, to). This is exact, because
/// all weights are multiples of kHalfWeightStep or kFloatWeightStep.
void remap_pixels(const FaceMatch& match, PixelMap& map);

}  // namespace imgmesh
