// Everything that a reader refuses in a container, by code. docs/format.md explains them; messages carry
// them.
#pragma once

#include <cstddef>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

#include "libcore/base/error.h"

namespace imgmesh {

/// One kind of defect: a stable code for machines and what it means.
struct Finding {
    std::string_view code;
    std::string_view meaning;
    ErrorCode error = ErrorCode::kBadFile;
};

/// All of them, from the outside of a file inwards.
inline constexpr Finding kFindings[] = {
    {"limits.bytes", "the files are larger than the limit"},
    {"limits.pixels", "the picture is larger than the limit"},
    {"limits.faces", "a mesh has more faces than the limit, or than its picture can have"},
    {"limits.levels", "more levels than the limit, or none"},
    {"glb.header", "not a glTF 2.0 binary header"},
    {"glb.length", "the length in the header is not the file's"},
    {"glb.chunk", "a chunk is missing or runs over the end"},
    {"json.syntax", "not JSON, or not UTF-8"},
    {"json.depth", "nested deeper than the limit"},
    {"gltf.version", "not glTF 2.x", ErrorCode::kUnsupported},
    {"gltf.required", "requires an extension that imgmesh does not know", ErrorCode::kUnsupported},
    {"gltf.structure", "a member is missing or has another type than it must"},
    {"gltf.index", "an index points beyond its array"},
    {"gltf.range", "a byte range runs over its buffer or is misaligned"},
    {"gltf.buffer", "not exactly one buffer, or one shorter than it says"},
    {"uri.name", "a URI is not the bare name of a file beside"},
    {"ext.missing", "no extension IMGMESH_pixel_map"},
    {"ext.version", "a version of IMGMESH_pixel_map that this reader does not know", ErrorCode::kUnsupported},
    {"ext.member", "a member of IMGMESH_pixel_map is missing or not what it must be"},
    {"ext.level", "the levels are not lod0, lod1, ... each once"},
    {"draco.header", "not a Draco mesh, or of another bitstream version"},
    {"draco.attributes", "the Draco mesh has other attributes than POSITION and COLOR_0"},
    {"draco.data", "the Draco mesh is broken"},
    {"mesh.accessor", "an accessor has another type than it must"},
    {"mesh.counts", "the numbers of vertices or faces disagree"},
    {"mesh.index", "a face points beyond the vertices"},
    {"mesh.position", "a position is not a multiple of 1/32 pixel, too far out, or has z != 0"},
    {"mesh.color", "a colour has alpha other than 1"},
    {"mesh.orientation", "a face has no area or runs clockwise"},
    {"mesh.topology", "faces or positions changed since the pixel map was made"},
    {"layers.size", "the EXR is too small for the picture"},
    {"layers.header", "the EXR's header is broken"},
    {"layers.version", "an imgmesh:version that this reader does not know", ErrorCode::kUnsupported},
    {"layers.type", "a part is neither scanline nor tiled in one level of small tiles"},
    {"layers.parts", "the parts are not the levels"},
    {"layers.topology", "a part was made for another mesh"},
    {"layers.window", "a part's window is not the picture"},
    {"layers.compression", "a compression other than none, ZIPS and ZIP"},
    {"layers.channels", "a channel is missing, unknown, subsampled or of another type"},
    {"layers.data", "the EXR's pixels are broken"},
    {"layers.face_range", "a face.id at or above the number of faces"},
    {"layers.weights", "weights outside the simplex, or not finite"},
    {"layers.mask", "a pixel outside the mask has weights, or there is no mask"},
};

/// One of kFindings, by its code; any other does not compile.
struct FindingCode {
    std::size_t index = 0;
    consteval FindingCode(const char* code) {
        while (index < std::size(kFindings) && kFindings[index].code != code) ++index;
        if (index == std::size(kFindings)) throw "not in kFindings";
    }
};

/// What the codecs throw: a code and one line about what was found, without the file's name, which they do
/// not know. read_container turns it into an Error.
class FindingError : public std::runtime_error {
  public:
    FindingError(FindingCode code, const std::string& text)
        : std::runtime_error(text), finding_(&kFindings[code.index]) {}
    std::string_view code() const { return finding_->code; }
    ErrorCode error_code() const { return finding_->error; }

  private:
    const Finding* finding_;
};

[[noreturn]] inline void refuse(FindingCode code, const std::string& text) {
    throw FindingError(code, text);
}

}  // namespace imgmesh
