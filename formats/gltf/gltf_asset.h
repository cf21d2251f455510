// The JSON of a container: what a glTF document says about the levels, and where their bytes are.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/exr/exr_metadata.h"
#include "formats/findings/limits.h"
#include "formats/gltf/byte_range.h"
#include "formats/gltf/draco_mesh.h"
#include "formats/gltf/layer_layout.h"
#include "formats/gltf/meshopt_views.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

class Findings;

/// One level: its node, mesh and accessors.
struct AssetLevel {
    std::uint64_t vertices = 0;
    std::uint64_t faces = 0;
    double error = 0;
    std::string topology;  ///< topology_hash()
    Bounds bounds;         ///< of the stored positions
    bool is_draco = false;
    ByteRange draco;  ///< is_draco: the bitstream and its attributes
    DracoAttributeIds ids;
    ByteRange indices, positions, colors;  ///< else: uint32, 3 float32, 4 uint16, tightly packed
    ByteRange hdr = {};                    ///< 3 float32
    std::vector<ByteRange> channels = {};  ///< float32
    ByteRange texcoords = {};              ///< 2 float32
    bool has_texcoords = false;
    bool is_sound = true;  ///< false only for a validator: only the node's index is known
    bool operator==(const AssetLevel&) const = default;
};

/// Returns how many bytes of the buffer hold the level's mesh, as compressed by Draco if it is.
std::uint64_t stored_bytes(const AssetLevel& level);

/// The place of a level in the document.
struct LevelPlace {
    std::uint64_t node = 0, mesh = 0;
    /// A JSON pointer to the primitive, or to the member of its Draco extension.
    std::string pointer;
};

/// A buffer of a glTF asset has at most this many bytes: many readers have signed 32-bit offsets.
inline constexpr std::uint64_t kMaxBufferBytes = 0x7FFFFFFF;

struct Asset {
    std::string version;  ///< of IMGMESH_pixel_map
    SourceInfo source;
    ExrMetadata metadata = {};  ///< of the source
    std::string generator;
    std::vector<BuildParameter> parameters;  ///< comes back sorted by name
    std::vector<AssetLevel> levels;          ///< 0 is the finest
    std::uint64_t buffer_length = 0;
    std::string buffer_name;                 ///< the sidecar file; empty for a .glb's binary chunk
    LayerLayout layout = LayerLayout::kExr;  ///< of the layers
    ByteRange layers;                        ///< these in the buffer, if `layers_name` is empty
    std::string layers_name;                 ///< or their sidecar file

    ByteRange texture;         ///< the image on the meshes, in the buffer
    std::string texture_type;  ///< its mimeType; empty for no texture

    /// Compressed arrays of the levels, whose ranges are then in a fallback buffer of this length; only for a
    /// writer.
    std::vector<MeshoptView> meshopt = {};
    std::uint64_t fallback_length = 0;

    std::vector<LevelPlace> places;  ///< of the levels, as read
    // What a validator may check further; always true for a reader. A writer omits IMGMESH_pixel_map if
    // has_layers is false.
    bool has_size = true;    ///< of the image
    bool has_levels = true;  ///< their number is known
    bool has_layers = true;  ///< the place of the layers is known
    bool has_buffer = true;  ///< likewise
};

/// Returns the attributes of such an image's meshes beside positions, and the names of its channels'
/// attributes in their order.
StoredLayout layout_of(const SourceInfo& source);
std::vector<std::string> channel_attributes(const SourceInfo& source);

/// Returns the name of level k's node and EXR part.
std::string level_name(std::size_t k);

/// Where level k's node stands: the image centred at the origin, its longer side one unit, coarser levels
/// behind.
struct NodePlace {
    double scale;  ///< of all three axes
    double x, y, z;
};
NodePlace node_place(const SourceInfo& source, std::size_t k);

/// The glTF document. Throws Error(kUnsupported) for a buffer above 2 GiB, which many readers cannot address.
std::string json_from_asset(const Asset& asset);

/// The inverse. Every number is checked: sizes against `limits`, counts against each other, ranges against
/// buffer_length. Safe for any text. Throws FindingError where `findings` does, or nothing can be said about
/// the rest.
Asset asset_from_json(std::string_view json, const ContainerLimits& limits, Findings& findings);
Asset asset_from_json(std::string_view json, const ContainerLimits& limits);  ///< strict findings

}  // namespace imgmesh
