// tinygltf reads the glTF 2.0 part, of a document reduced to what a container needs: it follows no URI,
// decodes no image and does not recurse deeply then. What it does not check is checked here: indices,
// ranges, integers above 32 bits (which it truncates). Our extension is read from the JSON itself.
#include <tiny_gltf.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "formats/findings/findings.h"
#include "formats/findings/json_members.h"
#include "formats/findings/json_parse.h"
#include "formats/gltf/extension_read.h"
#include "formats/gltf/file_uri.h"
#include "formats/gltf/gltf_asset.h"
#include "formats/gltf/gltf_lint.h"
#include "formats/gltf/gltf_names.h"
#include "formats/gltf/gltf_texture.h"
#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {
namespace {

using nlohmann::json;

// ---- The glTF part
// --------------------------------------------------------------------------------------------
void check_integers(const json& value, const char* where) {
    if (value.is_number_integer()) {
        const bool fits = value.is_number_unsigned()
                              ? value.get<std::uint64_t>() <= std::numeric_limits<int>::max()
                              : value.get<std::int64_t>() >= std::numeric_limits<int>::min();
        if (!fits)
            refuse("gltf.integer", cat("a number in \"", where, "\" has more than 32 bits"),
                   at_pointer(cat('/', where)));
    } else if (value.is_structured()) {
        for (const json& item : value) check_integers(item, where);
    }
}

void check_version(const json& document) {
    const json& asset = member(document, "asset", "gltf.structure");
    const std::string version = string_member(asset, "version", "gltf.structure");
    if (!version.starts_with("2.")) refuse("gltf.version", cat("glTF version ", version, ", expected 2.0"));
}

void check_required(const json& document, Findings& findings) {
    if (const json* required = find(document, "extensionsRequired"))
        for (const json& name : *required)
            if (name != kDraco && name != kUnlit && name != kPixelMap)
                findings.add("gltf.required", cat("the asset requires the extension ", name.dump()),
                             at_pointer("/extensionsRequired"));
}

tinygltf::Model load_model(const json& document) {
    // check_version() checks the document's own version, and a validator continues without one.
    json reduced = {{"asset", {{"version", "2.0"}}}};
    for (const char* name : {"accessors", "bufferViews", "meshes", "nodes"}) {
        reduced[name] = member(document, name, "gltf.structure");
        if (!reduced[name].is_array()) refuse("gltf.structure", cat("\"", name, "\" is not an array"));
        check_integers(reduced[name], name);
    }
    // tinygltf refuses indices without a bufferView, which is what Draco leaves of them.
    for (json& mesh : reduced["meshes"])
        if (mesh.is_object() && mesh.contains("primitives") && mesh["primitives"].is_array())
            for (json& primitive : mesh["primitives"])
                if (primitive.is_object()) primitive.erase("indices");
    tinygltf::Model model;
    std::string error, warning;
    const std::string text = reduced.dump();
    if (!tinygltf::TinyGLTF().LoadASCIIFromString(&model, &error, &warning, text.c_str(),
                                                  static_cast<unsigned>(text.size()), "",
                                                  tinygltf::NO_REQUIRE))
        refuse("gltf.structure", error);
    return model;
}

template <typename T>
const T& at(const std::vector<T>& items, std::uint64_t index, const char* what) {
    if (index >= items.size()) refuse("gltf.index", cat(what, " ", index, " of ", items.size()));
    return items[index];
}

// Converts an index that tinygltf gives as int, -1 for none.
template <typename T>
const T& at(const std::vector<T>& items, int index, const char* what) {
    if (index < 0) refuse("gltf.structure", cat("no ", what));
    return at(items, static_cast<std::uint64_t>(index), what);
}

ByteRange view_range(const tinygltf::Model& model, std::uint64_t index, std::uint64_t buffer_length) {
    const tinygltf::BufferView& view = at(model.bufferViews, index, "bufferView");
    const std::string pointer = cat("/bufferViews/", index);
    if (view.buffer != 0) refuse("gltf.index", cat("buffer ", view.buffer, " of 1"), at_pointer(pointer));
    if (view.byteOffset > buffer_length || view.byteLength > buffer_length - view.byteOffset)
        refuse("gltf.range",
               cat("bufferView ", index, " covers ", view.byteLength, " bytes from ", view.byteOffset,
                   ", the buffer has ", buffer_length),
               at_pointer(pointer));
    return {view.byteOffset, view.byteLength};
}

struct Element {
    const char* name;
    int component, type;
    bool normalized;
    std::uint64_t bytes;
};
constexpr Element kIndices = {"indices", TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, false,
                              4};
constexpr Element kPositions = {"POSITION", TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, false, 12};
constexpr Element kColors = {"COLOR_0", TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4, true, 8};
constexpr Element kHiddenColors = {kHiddenColor, kColors.component, kColors.type, true, kColors.bytes};
constexpr Element kTexcoords = {kTexcoord, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2, false, 8};
constexpr Element kLights = {kHdr, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, false, 12};

const tinygltf::Accessor& checked_accessor(const tinygltf::Model& model, std::uint64_t index,
                                           const Element& want, std::uint64_t count) {
    const tinygltf::Accessor& accessor = at(model.accessors, index, "accessor");
    const Place place = at_pointer(cat("/accessors/", index));
    if (accessor.componentType != want.component || accessor.type != want.type ||
        accessor.normalized != want.normalized || accessor.sparse.isSparse)
        refuse("mesh.accessor", cat("the accessor of ", want.name, " has another type"), place);
    if (accessor.count != count)
        refuse("mesh.counts",
               cat("the accessor of ", want.name, " has ", accessor.count, " items, expected ", count),
               place);
    return accessor;
}

ByteRange accessor_range(const tinygltf::Model& model, const tinygltf::Accessor& accessor,
                         const Element& want, std::uint64_t buffer_length) {
    const tinygltf::BufferView& view = at(model.bufferViews, accessor.bufferView, "bufferView");
    if (view.byteStride != 0 && view.byteStride != want.bytes)
        refuse("mesh.accessor", cat(want.name, " is not tightly packed"));
    ByteRange range = view_range(model, static_cast<std::uint64_t>(accessor.bufferView), buffer_length);
    // The count was checked against the limits.
    const std::uint64_t length = accessor.count * want.bytes;
    if (accessor.byteOffset > range.length || length > range.length - accessor.byteOffset)
        refuse("gltf.range", cat("the accessor of ", want.name, " runs over its bufferView"));
    return {range.offset + accessor.byteOffset, length};
}

std::uint64_t attribute_index(const tinygltf::Primitive& primitive, const char* name) {
    const auto it = primitive.attributes.find(name);
    if (it == primitive.attributes.end() || it->second < 0)
        refuse("gltf.attribute", cat("the mesh has no attribute ", name));
    return static_cast<std::uint64_t>(it->second);
}

bool has_attribute(const tinygltf::Model& model, int mesh, const char* name) {
    if (mesh < 0 || static_cast<std::size_t>(mesh) >= model.meshes.size()) return false;
    const auto& primitives = model.meshes[static_cast<std::size_t>(mesh)].primitives;
    return !primitives.empty() && primitives[0].attributes.contains(name);
}

// The attributes with the features of pixels, each with the place for its Draco id and for its bytes.
struct FeatureAttribute {
    Element element;
    std::uint32_t* id;
    ByteRange* bytes;
};

std::vector<FeatureAttribute> feature_attributes(const StoredLayout& layout,
                                                 const std::vector<std::string>& names,
                                                 const tinygltf::Primitive& primitive, AssetLevel& level) {
    level.ids = draco_ids(layout);
    level.channels.resize(names.size());
    level.has_texcoords = layout.texture;
    std::vector<FeatureAttribute> out;
    const bool hidden =
        primitive.attributes.contains(kHiddenColor) && !primitive.attributes.contains("COLOR_0");
    if (layout.color) out.push_back({hidden ? kHiddenColors : kColors, &*level.ids.color, &level.colors});
    if (layout.hdr) out.push_back({kLights, &*level.ids.hdr, &level.hdr});
    for (std::size_t c = 0; c < names.size(); ++c)
        out.push_back({{names[c].c_str(), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, false, 4},
                       &level.ids.channels[c],
                       &level.channels[c]});
    if (layout.texture) out.push_back({kTexcoords, &*level.ids.texcoord, &level.texcoords});
    return out;
}

// Fills in the places of a level's mesh.
void read_primitive(const json& document, const tinygltf::Model& model, int mesh_index, const Asset& asset,
                    AssetLevel& level) {
    const std::uint64_t buffer_length = asset.buffer_length;
    const tinygltf::Mesh& mesh = at(model.meshes, mesh_index, "mesh");
    if (mesh.primitives.size() != 1 || mesh.primitives[0].mode != TINYGLTF_MODE_TRIANGLES)
        refuse("gltf.primitive", cat("mesh ", mesh_index, " is not one primitive of triangles"));
    const tinygltf::Primitive& primitive = mesh.primitives[0];
    // tinygltf drops what it does not recognise as a primitive.
    const json& sources = document["meshes"][static_cast<std::size_t>(mesh_index)]["primitives"];
    if (sources.size() != 1)
        refuse("gltf.primitive", cat("mesh ", mesh_index, " has something else than a primitive"));
    const json& source = sources[0];
    const auto& indices = checked_accessor(model, unsigned_member(source, "indices", "gltf.structure"),
                                           kIndices, 3 * level.faces);
    const auto& positions =
        checked_accessor(model, attribute_index(primitive, "POSITION"), kPositions, level.vertices);
    const std::vector<std::string> names = channel_attributes(asset.source);
    const json* extensions = find(source, "extensions");
    const json* draco = extensions ? find(*extensions, kDraco) : nullptr;
    StoredLayout layout = layout_of(asset.source);
    layout.texture = primitive.attributes.contains(kTexcoord);
    const std::vector<FeatureAttribute> features = feature_attributes(layout, names, primitive, level);
    for (const FeatureAttribute& feature : features)
        checked_accessor(model, attribute_index(primitive, feature.element.name), feature.element,
                         level.vertices);
    if (positions.minValues.size() != 3 || positions.maxValues.size() != 3)
        refuse("mesh.accessor", "the accessor of POSITION has no bounds");
    for (std::size_t i = 0; i < 3; ++i) {
        level.bounds.low[i] = static_cast<float>(positions.minValues[i]);
        level.bounds.high[i] = static_cast<float>(positions.maxValues[i]);
    }
    if (draco) {
        const json& attributes = member(*draco, "attributes", "gltf.structure");
        const auto id = [&](const char* name) {
            return static_cast<std::uint32_t>(unsigned_member(attributes, name, "gltf.structure"));
        };
        level.is_draco = true;
        level.ids.position = id("POSITION");
        for (const FeatureAttribute& feature : features) *feature.id = id(feature.element.name);
        level.draco =
            view_range(model, unsigned_member(*draco, "bufferView", "gltf.structure"), buffer_length);
    } else {
        level.indices = accessor_range(model, indices, kIndices, buffer_length);
        level.positions = accessor_range(model, positions, kPositions, buffer_length);
        for (const FeatureAttribute& feature : features)
            *feature.bytes = accessor_range(
                model, at(model.accessors, attribute_index(primitive, feature.element.name), "accessor"),
                feature.element, buffer_length);
    }
}

void read_levels(const json& document, const tinygltf::Model& model, const ContainerLimits& limits,
                 Findings& findings, Asset& asset) {
    std::vector<std::pair<std::string, std::size_t>> parts;  // part, node
    const json& nodes = document["nodes"];
    const auto extension = [&](std::size_t node) {
        const json* extensions = find(nodes[node], "extensions");
        return extensions ? find(*extensions, kPixelMap) : nullptr;
    };
    for (std::size_t node = 0; node < nodes.size(); ++node)
        if (const json* found = extension(node))
            parts.emplace_back(string_member(*found, "part", "ext.member"), node);
    if (parts.empty() || parts.size() > static_cast<std::size_t>(limits.max_levels))
        refuse("limits.levels", cat(parts.size(), " levels, expected 1 to ", limits.max_levels));
    const std::uint64_t pixels = std::uint64_t(asset.source.width) * std::uint64_t(asset.source.height);
    if (pixels * parts.size() > static_cast<std::uint64_t>(limits.max_pixels))
        refuse("limits.pixels", cat(parts.size(), " levels of ", asset.source.width, "x", asset.source.height,
                                    " pixels, at most ", limits.max_pixels, " in all"));
    const int features = split_names(asset.source.channel_names).features();
    const double vertex_bytes = sizeof(Vec2f) + sizeof(float) * static_cast<double>(features);
    double memory = 0;
    for (std::size_t k = 0; k < parts.size(); ++k) {
        const auto part =
            std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.first == level_name(k); });
        if (part == parts.end())
            refuse("ext.level", cat("no node has the part ", level_name(k), " of ", parts.size(), " levels"));
        const std::size_t node = part->second;
        const int mesh = model.nodes[node].mesh;
        const std::string at_node = cat("/nodes/", node), at_mesh = cat("/meshes/", mesh);
        if (k == 0 && has_attribute(model, mesh, kHdr)) asset.source.gamut = Gamut::kHdr;
        AssetLevel level;
        level.is_sound = findings.attempt(cat(at_node, "/extensions/", kPixelMap), [&] {
            level = read_level_member(*extension(node), asset.source, limits);
        }) && findings.attempt(mesh < 0 ? at_node : at_mesh, [&] {
            read_primitive(document, model, mesh, asset, level);
        });
        level.is_sound = level.is_sound && findings.attempt(at_mesh, [&] {
            const auto texture = texture_view(document, static_cast<std::uint64_t>(mesh));
            if (!texture || k > 0) return;
            asset.texture = view_range(model, texture->view, asset.buffer_length);
            asset.texture_type = texture->type;
        });
        const double mesh_bytes = static_cast<double>(level.faces) * sizeof(std::array<Id, 3>) +
                                  static_cast<double>(level.vertices) * vertex_bytes;
        memory += static_cast<double>(pixels) * sizeof(PixelCoord) + mesh_bytes;
        asset.levels.push_back(std::move(level));
        asset.places.push_back({node, static_cast<std::uint64_t>(std::max(mesh, 0)), at_mesh});
    }
    if (memory > static_cast<double>(limits.max_memory))
        refuse("limits.memory", cat("the levels take ", static_cast<std::uint64_t>(memory),
                                    " bytes of memory, at most ", limits.max_memory, " are to be taken"));
}

void read_layers_member(const json& layers, const tinygltf::Model& model, Asset& asset) {
    const std::string type = string_member(layers, "mimeType", "ext.member");
    constexpr auto kExr = LayerLayout::kExr, kCompact = LayerLayout::kCompact;
    if (type != media_type(kExr) && type != media_type(kCompact))
        refuse("ext.value",
               cat("the layers are of type ", type, ", expected ", media_type(kExr), " or ",
                   media_type(kCompact)),
               at_pointer("mimeType"));
    asset.layout = type == media_type(kExr) ? kExr : kCompact;
    if (layers.contains("uri") == layers.contains("bufferView"))
        refuse("ext.layers", "the layers have not either a uri or a bufferView");
    if (layers.contains("uri"))
        asset.layers_name = name_from_uri(string_member(layers, "uri", "ext.member"));
    else
        asset.layers =
            view_range(model, unsigned_member(layers, "bufferView", "ext.member"), asset.buffer_length);
}

void read_buffer(const json& document, Asset& asset) {
    const json& buffers = member(document, "buffers", "gltf.buffer");
    if (!buffers.is_array() || buffers.size() != 1)
        refuse("gltf.buffer", cat(buffers.size(), " buffers, expected one"));
    asset.buffer_length = unsigned_member(buffers[0], "byteLength", "gltf.buffer");
    if (find(buffers[0], "uri"))
        asset.buffer_name = name_from_uri(string_member(buffers[0], "uri", "gltf.buffer"));
}

}  // namespace

Asset asset_from_json(std::string_view text, const ContainerLimits& limits, Findings& findings) {
    const json document = parse_json(text, {.max_depth = limits.max_json_depth}, findings);
    if (!document.is_object()) refuse("gltf.structure", "the document is not a JSON object");
    findings.attempt("/asset", [&] { check_version(document); });
    const json* extensions = find(document, "extensions");
    const json* root = extensions ? find(*extensions, kPixelMap) : nullptr;
    if (!root)
        refuse("ext.missing", cat("a plain mesh, which has no pixel map, that is, no extension ", kPixelMap,
                                  "; imgmesh-build without no-map makes one from the image"));
    check_required(document, findings);

    Asset asset;
    const std::string at_root = cat("/extensions/", kPixelMap);
    findings.attempt(at_root, [&] {
        asset.version = string_member(*root, "version", "ext.member");
        if (!asset.version.starts_with("1."))
            refuse("ext.version", cat(kPixelMap, " version ", asset.version, ", expected 1.x"),
                   at_pointer("version"));
    });
    asset.has_size = findings.attempt(at_root + "/image", [&] {
        asset.source = read_image_member(member(*root, "image", "ext.member"), limits);
    });
    if (asset.has_size)
        findings.attempt(at_root + "/image", [&] {
            asset.metadata = read_metadata_member(member(*root, "image", "ext.member"), asset.source);
        });
    findings.attempt(at_root + "/build",
                     [&] { read_build_member(member(*root, "build", "ext.member"), asset); });
    asset.has_buffer = findings.attempt("/buffers", [&] { read_buffer(document, asset); });

    const tinygltf::Model model = load_model(document);
    asset.has_layers = findings.attempt(at_root + "/layers", [&] {
        const json& layers = member(*root, "layers", "ext.member");
        if (asset.has_buffer || layers.contains("uri")) read_layers_member(layers, model, asset);
    });
    asset.has_levels = asset.has_size && asset.has_buffer && findings.attempt("/nodes", [&] {
        read_levels(document, model, limits, findings, asset);
    });
    if (findings.collects()) lint_gltf(document, asset, findings);
    return asset;
}

Asset asset_from_json(std::string_view text, const ContainerLimits& limits) {
    Findings findings = Findings::strict();
    return asset_from_json(text, limits, findings);
}

}  // namespace imgmesh
