// The container: a glTF asset (.glb or .gltf) with the base meshes and an EXR with the pixel maps; see
// docs/format.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/findings/limits.h"
#include "formats/gltf/draco_mode.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// An image that viewers put on the meshes, instead of the vertices' colours.
struct Texture {
    std::vector<std::uint8_t> picture;  ///< a PNG or JPEG file in sRGB; empty for no texture
    /// Where in it the vertices of each level are: from (0, 0), the corner of the top-left pixel, to (1, 1)
    std::vector<std::vector<Vec2f>> coords;
};

/// Texture::coords with every vertex at its own place: ((x + 0.5) / W, (y + 0.5) / H).
std::vector<std::vector<Vec2f>> texture_coords(const MeshImage& mesh_image);

struct ContainerOptions {
    DracoMode draco = DracoMode::kEdgebreaker;
    bool overwrite = true;  ///< replace what stands at the path; other files are never replaced
    /// files that stay although the .gltf that is replaced refers to them: those that were read
    std::vector<std::string> keep = {};
    bool layers = true;    ///< false: the meshes alone, a plain glTF asset that read_container refuses
    Texture texture = {};  ///< with the coordinates of all vertices of all levels
};

/// Writes `mesh_image`; the extension of `path` (.glb or .gltf) decides the spelling.
///
/// Loses nothing of a MeshImage whose positions lie on kPositionStep, whose colours are 16-bit linear codes
/// (quantized_color, libcore/image/color.h) and whose weights lie on the map's precision grid: read_container
/// gives the same mesh and map back, up to the order of vertices and faces and the rotation of corners, which
/// Draco chooses, and vertices without a face. The .gltf gets its name after what it refers to, and the files
/// of a container that it replaces go last: at any moment the old container stands there or the new one.
/// Throws Error: kBadArgument for another extension; kIo where a file cannot be written.
void write_container(const std::string& path, const MeshImage& mesh_image,
                     const ContainerOptions& options = {});

/// The names that write_container prefers for the files of `path`, itself first: a .gltf has a .bin and a
/// .exr beside it, which get names with a hash where other files have these. Throws Error(kBadArgument) for
/// another extension.
std::vector<std::string> container_files(const std::string& path);

/// Facts of the file that a MeshImage does not hold.
struct ContainerFacts {
    std::string version;  ///< of the extension
    DracoMode draco = DracoMode::kOff;
    std::vector<std::string> files;  ///< as read, the named one first
    std::uint64_t total_bytes = 0;   ///< all files together
    std::uint64_t mesh_bytes = 0;    ///< meshes as stored, compressed
    std::uint64_t layer_bytes = 0;   ///< the EXR
    std::uint64_t texture_bytes = 0;
};

struct Container {
    MeshImage mesh_image;
    ContainerFacts facts;
    Texture texture;  ///< as it is stored; not looked into
};

/// Reads and checks a container: topology hash, ranges, simplex, limits; URIs stay in the container's folder.
/// Throws Error: kIo where a file cannot be read; kBadFile for the first finding, or kUnsupported for a newer
/// version, with its code (formats/findings/finding_codes.h), as in "x.glb: [layers.face_range] ...".
/// Parameters come back sorted by name.
Container read_container(const std::string& path, const ContainerLimits& limits = {});

}  // namespace imgmesh
