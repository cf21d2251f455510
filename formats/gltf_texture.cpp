// Source: glTF 2.0 specification, sections 3.8 (texture data) and 3.9 (materials): the base colour is the
// product of texture, factor and COLOR_0.
#include "formats/gltf_texture.h"

#include <algorithm>
#include <array>

#include "formats/findings.h"
#include "formats/gltf_asset.h"
#include "formats/gltf_names.h"
#include "formats/json_members.h"

namespace imgmesh {
namespace {

using nlohmann::json;

constexpr const char* kPng = "image/png";
constexpr const char* kJpeg = "image/jpeg";
// OpenGL's numbers. At the sides the picture's own pixels go on: the other side's do not mix in.
constexpr int kClampToEdge = 33071, kLinear = 9729, kLinearMipmapLinear = 9987;

// document[name][index]. `index` is that of `object`'s member of the name `key`.
const json& referred(const json& document, const char* name, const json& object, const char* key) {
    const std::uint64_t index = unsigned_member(object, key, "gltf.structure");
    const json* list = find(document, name);
    const std::size_t size = list && list->is_array() ? list->size() : 0;
    if (index >= size) refuse("gltf.index", cat(key, " ", index, " of ", size), at_pointer(cat('/', name)));
    return (*list)[index];
}

const json& first_primitive(const json& document, std::uint64_t mesh) {
    return document["meshes"][mesh]["primitives"][0];  // a sound level has it
}

// The baseColorTexture of a primitive's material; null for none.
const json* base_texture(const json& document, const json& primitive) {
    if (!find(primitive, "material")) return nullptr;
    const json* roughness =
        find(referred(document, "materials", primitive, "material"), "pbrMetallicRoughness");
    return roughness ? find(*roughness, "baseColorTexture") : nullptr;
}

}  // namespace

std::string picture_type(std::span<const std::uint8_t> bytes) {
    constexpr std::array<std::uint8_t, 8> kPngStart = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    constexpr std::array<std::uint8_t, 3> kJpegStart = {0xFF, 0xD8, 0xFF};
    const auto starts = [&](const auto& with) {
        return bytes.size() > with.size() && std::equal(with.begin(), with.end(), bytes.begin());
    };
    return starts(kPngStart) ? kPng : starts(kJpegStart) ? kJpeg : "";
}

void add_texture(json& document, int view, const std::string& type, bool cut_out) {
    document["images"] = json::array({{{"bufferView", view}, {"mimeType", type}, {"name", "picture"}}});
    document["samplers"] = json::array({{{"magFilter", kLinear},
                                         {"minFilter", kLinearMipmapLinear},
                                         {"wrapS", kClampToEdge},
                                         {"wrapT", kClampToEdge}}});
    document["textures"] = json::array({{{"sampler", 0}, {"source", 0}}});
    json& material = document["materials"][0];
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    if (cut_out) material["alphaMode"] = "MASK";  // at the default, 1/2
}

std::optional<TextureView> texture_view(const json& document, std::uint64_t mesh) {
    const json* info = base_texture(document, first_primitive(document, mesh));
    if (!info) return {};
    const json& texture = referred(document, "textures", *info, "index");
    if (!find(texture, "source")) return {};  // a format that an extension defines
    const json& image = referred(document, "images", texture, "source");
    const json* type = find(image, "mimeType");
    if (!find(image, "bufferView") || !type || (*type != kPng && *type != kJpeg)) return {};
    return TextureView{unsigned_member(image, "bufferView", "gltf.structure"), type->get<std::string>()};
}

void advise_on_texture(const json& document, const Asset& asset, std::size_t k, Findings& findings) {
    const std::uint64_t mesh = asset.places[k].mesh;
    const json& primitive = first_primitive(document, mesh);
    const json& attributes = primitive["attributes"];
    const std::string pointer = cat("/meshes/", mesh, "/primitives/0/");
    const auto tell = [&](FindingCode code, const char* text, const char* place) {
        findings.add(code, cat("level ", k, text), at_pointer(pointer + place));
    };
    const bool has_color = attributes.contains("COLOR_0"), has_coords = attributes.contains(kTexcoord);
    if (!base_texture(document, primitive)) {
        if (attributes.contains(kHiddenColor) && !has_color)
            tell("gltf.texture", " has no texture, and its colour where viewers do not look", "attributes");
        return;
    }
    if (has_color)
        tell("gltf.texture", " has a texture, and COLOR_0, by which viewers multiply it", "attributes");
    if (!has_coords) tell("gltf.texture", " has a texture without TEXCOORD_0", "attributes");
    if (!texture_view(document, mesh))
        tell("gltf.foreign", " has a texture that is no PNG or JPEG in a bufferView", "material");
}

}  // namespace imgmesh
