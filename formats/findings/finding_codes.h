// The findings: everything that can be wrong with a container, each with a code that never changes its
// meaning. Messages and reports carry the codes; docs/format.md explains them.
#pragma once

#include <string_view>

#include "libcore/base/error.h"

namespace imgmesh {

/// Readers refuse a container with an error. A warning is something that a careful writer would do otherwise,
/// an info something that readers ignore.
enum class Severity { kError, kWarning, kInfo };

/// One kind of defect: its code and what it means.
struct Finding {
    std::string_view code;
    std::string_view meaning;
    ErrorKind error = ErrorKind::kBadFile;  ///< of the Error that read_container() throws for it
    Severity severity = Severity::kError;
};

constexpr Finding warning(std::string_view code, std::string_view meaning) {
    return {code, meaning, ErrorKind::kBadFile, Severity::kWarning};
}
constexpr Finding info(std::string_view code, std::string_view meaning) {
    return {code, meaning, ErrorKind::kBadFile, Severity::kInfo};
}

/// All findings: first the errors, from the outside of a file inwards, then the warnings and infos.
inline constexpr Finding kFindings[] = {
    {"limits.bytes", "the files are larger than the limit"},
    {"limits.pixels", "the image, or all levels together, are larger than the limit"},
    {"limits.faces", "a mesh has more faces than the limit, or than its image can have"},
    {"limits.levels", "more levels than the limit, or none"},
    {"limits.memory", "the levels take more memory than the limit"},
    {"limits.json", "the JSON is longer than 64 MiB, or has more than 262,144 values"},
    {"glb.header", "not a glTF 2.0 binary header"},
    {"glb.length", "the length in the header is not the file's"},
    {"glb.chunk", "a chunk is missing or runs over the end"},
    {"json.syntax", "not JSON, or not UTF-8"},
    {"json.depth", "nested deeper than the limit"},
    {"gltf.version", "not glTF 2.x", ErrorKind::kUnsupported},
    {"gltf.required", "requires an extension that imgmesh does not know", ErrorKind::kUnsupported},
    {"gltf.structure", "a member is missing or has another type than it must"},
    {"gltf.primitive", "a level's mesh is not one primitive of triangles"},
    {"gltf.attribute", "a level's mesh lacks POSITION, COLOR_0 (or _COLOR) or the attribute of a channel"},
    {"gltf.integer", "a number has more than 32 bits"},
    {"gltf.index", "an index points beyond its array"},
    {"gltf.range", "a byte range runs over its buffer or bufferView"},
    {"gltf.buffer", "not exactly one buffer, or one shorter than it says"},
    {"uri.name", "a URI is not the bare name of a file beside"},
    {"ext.missing", "no extension IMGMESH_pixel_map"},
    {"ext.version", "a version of IMGMESH_pixel_map that this reader does not know", ErrorKind::kUnsupported},
    {"ext.member", "a member of IMGMESH_pixel_map is missing or not what it must be"},
    {"ext.value", "a colorSpace, sampleType or mimeType of IMGMESH_pixel_map is unknown"},
    {"ext.channels", "the channels are not 1 to 16 features, each with a name of its own"},
    {"ext.metadata", "the image's metadata are not attributes of an EXR, or more than 64 kB or 256"},
    {"ext.layers", "the layers have both or neither of uri and bufferView"},
    {"ext.level", "the levels are not lod0, lod1, ... each once"},
    {"draco.header", "not a Draco mesh"},
    {"draco.version", "the Draco bitstream has another version than 2.2"},
    {"draco.metadata", "the Draco mesh has metadata or unknown flags"},
    {"draco.attributes", "the Draco mesh has other attributes than the level's mesh"},
    {"draco.data", "the Draco mesh is broken"},
    {"mesh.accessor", "an accessor has another type than it must"},
    {"mesh.counts", "the numbers of vertices or faces disagree"},
    {"mesh.index", "a face points beyond the vertices"},
    {"mesh.position", "a position is not a multiple of 1/32 pixel, too far out, or has z != 0"},
    {"mesh.color", "a colour has alpha other than 1"},
    {"mesh.light", "an HDR colour is below 0, above 2^20 or not a number"},
    {"mesh.channel", "a channel's value is not finite"},
    {"mesh.orientation", "a face has no area or runs clockwise"},
    {"mesh.topology", "faces or positions changed since the pixel map was made"},
    {"layers.size", "the layers are too small for the image"},
    {"layers.magic", "neither an EXR file of version 2 nor a compact stream"},
    {"layers.header", "the layers' header is broken"},
    {"layers.attribute", "an attribute of the EXR is too long or of a type that a container does not need"},
    {"layers.version", "a version of the layers that this reader does not know", ErrorKind::kUnsupported},
    {"layers.type", "a part is deep or of an unknown type"},
    {"layers.tiles", "tiles of several levels, or larger than 1024 x 1024"},
    {"layers.parts", "the parts are not the levels"},
    {"layers.topology", "a part was made for another mesh"},
    {"layers.window", "a part's window is not the image"},
    {"layers.compression", "a compression other than none, ZIPS and ZIP"},
    {"layers.channels", "a channel is unknown, subsampled or of another type"},
    {"layers.missing", "a part lacks face.id, bary.u or bary.v"},
    {"layers.data", "the layers' pixels are broken"},
    {"layers.face_range", "a face.id at or above the number of faces"},
    {"layers.weights", "weights outside the simplex, or not finite"},
    {"layers.mask", "a pixel outside the mask has weights, or there is no mask"},

    warning("glb.padding", "a chunk's length is not a multiple of four"),
    info("glb.unknown_chunk", "a chunk that glTF 2.0 does not define"),
    warning("json.bom", "the JSON starts with a byte order mark"),
    warning("json.duplicate", "an object has a member twice; which one counts depends on the reader"),
    warning("uri.same", "two of the container's files have the same name"),
    warning("gltf.used", "an extension is used, but not in extensionsUsed"),
    warning("gltf.draco_optional", "Draco is not in extensionsRequired, although meshes have no other form"),
    warning("gltf.pixel_map_required", "IMGMESH_pixel_map is in extensionsRequired: viewers refuse the file"),
    warning("gltf.scene", "the default scene does not show level 0 alone"),
    warning("gltf.names", "a level's node or mesh is not named after its level"),
    warning("gltf.lod", "MSFT_lod of level 0 does not list the coarser levels in their order"),
    warning("gltf.material", "a level's material is not unlit and double sided"),
    warning("gltf.texture",
            "a level has a texture without TEXCOORD_0 or beside COLOR_0, or _COLOR without one"),
    warning("texture.data", "the texture is not a PNG or JPEG as its mimeType says"),
    warning("gltf.transform", "a level's node does not centre the image with its longer side one unit"),
    warning("gltf.image", "the layers are among the images, which viewers try to decode"),
    warning("gltf.overlap", "two bufferViews share bytes"),
    warning("gltf.alignment", "an accessor's bytes do not start at a multiple of four"),
    warning("gltf.buffer_tail", "the buffer goes on after its byteLength"),
    info("gltf.unused", "an accessor or bufferView that nothing refers to"),
    info("gltf.foreign", "objects that imgmesh does not read and its tools do not keep"),
    info("ext.unknown", "a member that version 1.1 of IMGMESH_pixel_map does not define"),
    warning("ext.order", "a coarser level has more faces, or a smaller error, than the one before it"),
    warning("draco.tail", "bytes after the end of a Draco mesh"),
    info("draco.mixed", "not all levels are compressed alike"),
    warning("mesh.bounds", "min and max of POSITION are not those of the mesh"),
    info("mesh.unused_vertex", "a vertex without a face"),
    warning("mesh.duplicate_face", "a face occurs twice"),
    warning("mesh.nonmanifold", "an edge has more than two faces, or two that run the same way"),
    warning("mesh.texcoord", "a vertex lies outside its texture"),
    warning("mesh.outside", "a vertex lies outside the image"),
    warning("mesh.area", "the faces do not cover the image, which has no mask"),
    warning("layers.unbound", "a part does not say which mesh it was made for"),
    warning("layers.visits", "visit.count in another part than lod0"),
    info("layers.grid", "weights that are no multiples of 2^-24 and are rounded down by readers"),
    info("layers.mask_unused", "image.hasMask is true, but every pixel has a face"),
};

}  // namespace imgmesh
