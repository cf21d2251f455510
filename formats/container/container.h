// The container: a glTF asset (.glb or .gltf) with the base meshes and layers with the pixel maps; see
// docs/format.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/exr/exr_metadata.h"
#include "formats/findings/limits.h"
#include "formats/gltf/draco_mode.h"
#include "formats/gltf/layer_layout.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// An image that viewers put on the meshes instead of the vertices' colours.
struct Texture {
    std::vector<std::uint8_t>
        picture;  ///< the bytes of a PNG or JPEG file in sRGB (encode_texture()); empty for none
    /// For each level the place of every vertex in it, from (0, 0), the top-left pixel's corner, to (1, 1).
    std::vector<std::vector<Vec2f>> coords;
};

/// Texture::coords with every vertex at its own place: ((x + 0.5) / W, (y + 0.5) / H).
std::vector<std::vector<Vec2f>> texture_coords(const MeshImage& mesh_image);

/// How write_container() writes.
struct ContainerOptions {
    DracoMode draco = DracoMode::kEdgebreaker;
    bool overwrite = true;  ///< replace the file at the path; other files are never replaced
    /// Files that stay although the .gltf that is replaced refers to them, such as those just read.
    std::vector<std::string> keep = {};
    /// kOff: a plain glTF asset that read_container() refuses; levels need no map. kCompact is for maps on a
    /// grid, as build_mesh_image() makes them unless they are tracked.
    LayerLayout layers = LayerLayout::kExr;
    bool meshopt = false;       ///< EXT_meshopt_compression instead of Draco; only without layers
    Texture texture = {};       ///< with the coordinates of all vertices of all levels
    ExrMetadata metadata = {};  ///< of the source, if it is an EXR; without an exr_metadata_fault()
    /// Of the buffer, which holds the meshes and in a .glb the pixel maps as well; at most 2^31 - 1.
    std::uint64_t max_buffer_bytes = 0x7FFFFFFF;
};

/// What is known of a container before it is built.
struct ContainerPlan {
    std::int64_t pixels = 0;    ///< with a pixel map, once for each level
    std::int64_t vertices = 0;  ///< of all levels, at least
};

/// Throws Error(kUnsupported) where the buffer of the container `path` will surely be too long, as
/// write_container() would after the work. Returns a warning where that is likely, as its pixel maps are
/// 3 bytes a pixel or more of most images; "" otherwise.
std::string check_buffer(const std::string& path, const ContainerPlan& plan, const ContainerOptions& options);

/// What write_container() has written.
struct WrittenContainer {
    std::vector<std::string> files;  ///< of the container, itself first
    std::uint64_t mesh_bytes = 0;    ///< the meshes, as compressed
    std::uint64_t layer_bytes = 0;   ///< the pixel maps; 0 without layers
};

/// Writes `mesh_image`; the extension of `path` (.glb or .gltf) decides the file variant.
///
/// Nothing is lost of what build_mesh_image() returns, nor of any MeshImage whose positions lie on
/// kPositionStep, whose colours are those of quantized_color() and whose weights lie on the grid of the map's
/// precision. read_container() gives the same meshes and maps back, but Draco chooses the order of vertices
/// and faces and the first corner of each face, and vertices without a face are dropped.
///
/// A .gltf appears after its sidecar files, and the sidecar files of a container that it replaces are removed
/// last: at any moment either the old container or the new one is there. The same mesh image and options give
/// the same bytes. Takes O(pixels + faces) time. Throws Error: kBadArgument for another extension; kIo if a
/// file cannot be written; kUnsupported if the buffer would be too long, and then no file has appeared.
WrittenContainer write_container(const std::string& path, const MeshImage& mesh_image,
                                 const ContainerOptions& options = {});

/// The files that write_container() writes for `path`, itself first. A .gltf has a .bin and, with layers, a
/// .exr or .imgmap as sidecar files; if other files have these names already, they get names with a hash.
/// Throws Error(kBadArgument) for another extension.
std::vector<std::string> container_files(const std::string& path, LayerLayout layers = LayerLayout::kExr);

/// Facts about the files that a MeshImage does not hold.
struct ContainerFacts {
    std::string version;  ///< of the extension
    DracoMode draco = DracoMode::kOff;
    std::vector<std::string> files;  ///< as read, the named one first
    std::uint64_t total_bytes = 0;   ///< all files together
    std::uint64_t mesh_bytes = 0;    ///< meshes as stored, compressed
    LayerLayout layout = LayerLayout::kExr;
    std::uint64_t layer_bytes = 0;  ///< the pixel maps
    std::uint64_t texture_bytes = 0;
};

/// What read_container() returns.
struct Container {
    MeshImage mesh_image;
    ContainerFacts facts;
    Texture texture;       ///< as stored, its image file not decoded
    ExrMetadata metadata;  ///< of the source
};

/// Reads a container and checks all of it: sizes against `limits` before memory is taken, indices, weights,
/// and by a hash whether the pixel maps were made for these meshes. Other files are read from the container's
/// own folder only. Safe for any bytes. Parameters come back sorted by name. Takes O(bytes + pixels) time.
///
/// Throws Error: kIo if a file cannot be read; kUnsupported for a newer version; kBadFile for anything
/// else that is wrong. The text has the code of the finding (finding_codes.h): "x.glb: [layers.face_range]
/// ...".
Container read_container(const std::string& path, const ContainerLimits& limits = {});

/// The same for the meshes alone: the pixel maps are neither decoded nor checked, and are empty. Takes
/// O(bytes + faces) time.
MeshImage read_meshes(const std::string& path, const ContainerLimits& limits = {});

}  // namespace imgmesh
