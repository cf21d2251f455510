// Source: glTF 2.0 specification, sections 3.8 (texture data) and 3.9 (materials): the base colour is the
// product of texture, factor and COLOR_0.
#include "formats/gltf/gltf_texture.h"

#include <algorithm>
#include <array>

#include "formats/findings/findings.h"
#include "formats/findings/json_members.h"
#include "formats/gltf/gltf_asset.h"
#include "formats/gltf/gltf_names.h"

namespace imgmesh {
namespace {

using nlohmann::json;

constexpr const char* kPng = "image/png";
constexpr const char* kJpeg = "image/jpeg";
// OpenGL's numbers. At the sides the image's own pixels continue: the opposite side's do not mix in.
constexpr int kClampToEdge = 33071, kLinear = 9729, kLinearMipmapLinear = 9987;

// An object of the document and its place.
struct Object {
    const json& value;
    std::string pointer;

    Object member(const char* name) const {
        const json* found = find(value, name);
        return {found ? *found : kNothing, cat(pointer, '/', name)};
    }
    explicit operator bool() const { return !value.is_null(); }

  private:
    static inline const json kNothing;
};

// Returns the object of the list `name` that an index means.
Object referred(const json& document, const char* name, const Object& index) {
    if (!index.value.is_number_unsigned())
        refuse("gltf.structure", cat("an index of ", name, " is not a whole number >= 0"),
               at_pointer(index.pointer));
    const auto i = index.value.get<std::uint64_t>();
    const json* list = find(document, name);
    const std::size_t size = list && list->is_array() ? list->size() : 0;
    if (i >= size) refuse("gltf.index", cat(i, " of ", size, " ", name), at_pointer(index.pointer));
    return {(*list)[i], cat('/', name, '/', i)};
}

// The primitive of a sound level.
Object first_primitive(const json& document, std::uint64_t mesh) {
    return {document["meshes"][mesh]["primitives"][0], cat("/meshes/", mesh, "/primitives/0")};
}

// Returns the baseColorTexture of a primitive's material; null if there is none.
Object base_texture(const json& document, const Object& primitive) {
    const Object material = primitive.member("material");
    if (!material) return material;
    return referred(document, "materials", material)
        .member("pbrMetallicRoughness")
        .member("baseColorTexture");
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

void add_texture(json& document, int view, const std::string& type) {
    document["images"] = json::array({{{"bufferView", view}, {"mimeType", type}, {"name", "picture"}}});
    document["samplers"] = json::array({{{"magFilter", kLinear},
                                         {"minFilter", kLinearMipmapLinear},
                                         {"wrapS", kClampToEdge},
                                         {"wrapT", kClampToEdge}}});
    document["textures"] = json::array({{{"sampler", 0}, {"source", 0}}});
    document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
}

std::optional<TextureView> texture_view(const json& document, std::uint64_t mesh) {
    const Object info = base_texture(document, first_primitive(document, mesh));
    if (!info) return {};
    const Object source = referred(document, "textures", info.member("index")).member("source");
    if (!source) return {};  // a format that an extension defines
    const Object image = referred(document, "images", source);
    const Object view = image.member("bufferView"), type = image.member("mimeType");
    if (!view || (type.value != kPng && type.value != kJpeg)) return {};
    referred(document, "bufferViews", view);
    return TextureView{view.value.get<std::uint64_t>(), type.value.get<std::string>()};
}

void lint_texture(const json& document, const Asset& asset, std::size_t k, Findings& findings) {
    const std::uint64_t mesh = asset.places[k].mesh;
    const Object primitive = first_primitive(document, mesh);
    const Object attributes = primitive.member("attributes"), texture = base_texture(document, primitive);
    const bool has_color = attributes.value.contains("COLOR_0");
    const auto tell = [&](FindingCode code, const char* text, const Object& place) {
        findings.add(code, cat("level ", k, text), at_pointer(place.pointer));
    };
    if (!texture) {
        if (attributes.value.contains(kHiddenColor) && !has_color)
            tell("gltf.texture", " has no texture, and its colour where viewers do not look", attributes);
        return;
    }
    if (has_color)
        tell("gltf.texture", " has a texture, and COLOR_0, by which viewers multiply it", attributes);
    if (!attributes.value.contains(kTexcoord))
        tell("gltf.texture", " has a texture without TEXCOORD_0", attributes);
    if (!texture_view(document, mesh))
        tell("gltf.foreign", " has a texture that is no PNG or JPEG in a bufferView",
             primitive.member("material"));
}

}  // namespace imgmesh
