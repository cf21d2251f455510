// tinygltf writes the glTF 2.0 part. Our extension is added to its JSON: tinygltf keeps only integers of 32
// bits.
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "formats/gltf/file_uri.h"
#include "formats/gltf/gltf_asset.h"
#include "formats/gltf/gltf_names.h"
#include "formats/gltf/gltf_texture.h"
#include "libcore/base/error.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

using nlohmann::json;
using tinygltf::Value;

int add_view(tinygltf::Model& model, const ByteRange& range, int target) {
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = range.offset;
    view.byteLength = range.length;
    view.target = target;
    model.bufferViews.push_back(view);
    return static_cast<int>(model.bufferViews.size()) - 1;
}

// `range` is null if the values are in a Draco bitstream.
int add_accessor(tinygltf::Model& model, int component, int type, std::uint64_t count, const ByteRange* range,
                 int target) {
    tinygltf::Accessor accessor;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    if (range) accessor.bufferView = add_view(model, *range, target);
    model.accessors.push_back(accessor);
    return static_cast<int>(model.accessors.size()) - 1;
}

tinygltf::Material unlit_material() {
    tinygltf::Material material;
    material.name = "unlit";
    material.doubleSided = true;
    // The fallback of viewers without the extension: no mirror.
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.extensions[kUnlit] = Value(Value::Object());
    return material;
}

tinygltf::Mesh level_mesh(tinygltf::Model& model, const AssetLevel& level, const SourceInfo& source) {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = 0;
    const auto range = [&](const ByteRange& bytes) { return level.is_draco ? nullptr : &bytes; };
    primitive.indices =
        add_accessor(model, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, 3 * level.faces,
                     range(level.indices), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    const int position = add_accessor(model, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                      level.vertices, range(level.positions), TINYGLTF_TARGET_ARRAY_BUFFER);
    auto& accessors = model.accessors;
    accessors[static_cast<std::size_t>(position)].minValues.assign(level.bounds.low.begin(),
                                                                   level.bounds.low.end());
    accessors[static_cast<std::size_t>(position)].maxValues.assign(level.bounds.high.begin(),
                                                                   level.bounds.high.end());
    primitive.attributes = {{"POSITION", position}};
    StoredLayout layout = layout_of(source);
    layout.texture = level.has_texcoords;
    const DracoAttributeIds ids = draco_ids(layout);
    Value::Object attributes = {{"POSITION", Value(static_cast<int>(ids.position))}};
    const auto add = [&](const std::string& name, int component, int type, const ByteRange& bytes,
                         std::uint32_t id) {
        primitive.attributes[name] =
            add_accessor(model, component, type, level.vertices, range(bytes), TINYGLTF_TARGET_ARRAY_BUFFER);
        attributes[name] = Value(static_cast<int>(id));
    };
    if (layout.color) {
        add(layout.texture ? kHiddenColor : "COLOR_0", TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
            TINYGLTF_TYPE_VEC4, level.colors, *ids.color);
        accessors.back().normalized = true;
    }
    if (layout.hdr) add(kHdr, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, level.hdr, *ids.hdr);
    const std::vector<std::string> names = channel_attributes(source);
    for (std::size_t c = 0; c < names.size(); ++c)
        add(names[c], TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR,
            level.is_draco ? ByteRange() : level.channels[c], ids.channels[c]);
    if (layout.texture)
        add(kTexcoord, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2, level.texcoords,
            ids.texcoord.value_or(0));
    if (level.is_draco) {
        primitive.extensions[kDraco] =
            Value(Value::Object{{"bufferView", Value(add_view(model, level.draco, 0))},
                                {"attributes", Value(std::move(attributes))}});
    }
    tinygltf::Mesh mesh;
    mesh.primitives.push_back(primitive);
    return mesh;
}

tinygltf::Node level_node(const SourceInfo& source, std::size_t k) {
    const NodePlace place = node_place(source, k);
    tinygltf::Node node;
    node.scale = {place.scale, place.scale, place.scale};
    node.translation = {place.x, place.y, place.z};
    return node;
}

tinygltf::Model gltf_model(const Asset& asset) {
    tinygltf::Model model;
    model.asset.version = "2.0";
    model.asset.generator = asset.generator;
    model.materials.push_back(unlit_material());
    model.extensionsUsed = {kUnlit};
    if (asset.has_layers) model.extensionsUsed.emplace_back(kPixelMap);
    const bool any_draco = std::any_of(asset.levels.begin(), asset.levels.end(),
                                       [](const AssetLevel& level) { return level.is_draco; });
    if (any_draco) {
        model.extensionsUsed.emplace_back(kDraco);
        model.extensionsRequired.emplace_back(kDraco);
    }
    if (!asset.meshopt.empty()) {
        model.extensionsUsed.emplace_back(kMeshopt);
        model.extensionsRequired.emplace_back(kMeshopt);
    }
    Value::Array coarser;
    for (std::size_t k = 0; k < asset.levels.size(); ++k) {
        model.meshes.push_back(level_mesh(model, asset.levels[k], asset.source));
        model.meshes.back().name = level_name(k) + "-mesh";
        model.nodes.push_back(level_node(asset.source, k));
        model.nodes.back().name = level_name(k);
        model.nodes.back().mesh = static_cast<int>(k);
        tinygltf::Scene scene;
        scene.name = level_name(k) + "-scene";
        scene.nodes = {static_cast<int>(k)};
        model.scenes.push_back(scene);
        if (k > 0) coarser.emplace_back(static_cast<int>(k));
    }
    model.defaultScene = 0;
    if (!coarser.empty()) {
        model.extensionsUsed.emplace_back(kLod);
        model.nodes[0].extensions[kLod] = Value(Value::Object{{"ids", Value(std::move(coarser))}});
    }
    return model;
}

// Says of the levels' views, which come first, how they are compressed, and adds the buffer that they would
// fill. Nobody has it: a reader that knows the extension decodes into one of its own.
void add_meshopt(json& document, const Asset& asset) {
    for (std::size_t i = 0; i < asset.meshopt.size(); ++i) {
        const MeshoptView& view = asset.meshopt[i];
        json& member = document["bufferViews"][i];
        member["buffer"] = 1;
        member["extensions"][kMeshopt] = {{"buffer", 0},
                                          {"byteOffset", view.encoded.offset},
                                          {"byteLength", view.encoded.length},
                                          {"byteStride", view.stride},
                                          {"count", view.count},
                                          {"mode", view.triangles ? "TRIANGLES" : "ATTRIBUTES"}};
    }
    document["buffers"].push_back(
        {{"byteLength", asset.fallback_length}, {"extensions", {{kMeshopt, {{"fallback", true}}}}}});
}

json metadata_member(const ExrMetadata& metadata) {
    json out = json::object();
    for (const ExrAttribute& attribute : metadata) {
        json value = attribute.numbers;
        if (exr_number_count(attribute.type) == 0) value = attribute.text;
        if (exr_number_count(attribute.type) == 1) value = attribute.numbers[0];
        out[attribute.name] = {{"type", attribute.type}, {"value", std::move(value)}};
    }
    return out;
}

json root_extension(const Asset& asset, int layers_view) {
    const SourceInfo& source = asset.source;
    json build = json::object();
    for (const auto& [name, value] : asset.parameters) {
        const auto* number = std::get_if<double>(&value);
        if (name == kGenerator || (number && !std::isfinite(*number)))
            throw Error(ErrorKind::kInternal, cat("cannot store the build parameter ", name));
        json& member = build[name];
        std::visit([&](const auto& v) { member = v; }, value);
    }
    build[kGenerator] = asset.generator;
    json layers = {{"mimeType", media_type(asset.layout)}};
    if (asset.layers_name.empty())
        layers["bufferView"] = layers_view;
    else
        layers["uri"] = uri_from_name(asset.layers_name);
    json image = {{"width", source.width},
                  {"height", source.height},
                  {"colorSpace", color_space_name(source.color_space)},
                  {"sampleType", kSampleTypes[static_cast<std::size_t>(source.sample_type)]},
                  {"channels", source.channel_names},
                  {"hasMask", source.has_mask}};
    if (!asset.metadata.empty()) image["metadata"] = metadata_member(asset.metadata);
    return {{"version", asset.version},
            {"image", std::move(image)},
            {"layers", std::move(layers)},
            {"build", std::move(build)}};
}

}  // namespace

std::uint64_t stored_bytes(const AssetLevel& level) {
    std::uint64_t bytes = 0;
    for (const ByteRange& range :
         {level.draco, level.indices, level.positions, level.colors, level.hdr, level.texcoords})
        bytes += range.length;
    for (const ByteRange& range : level.channels) bytes += range.length;
    return bytes;
}

std::string level_name(std::size_t k) {
    return cat("lod", k);
}

NodePlace node_place(const SourceInfo& source, std::size_t k) {
    // In units of the image's longer side, so that a viewer that draws all levels does not draw two at one
    // depth.
    constexpr double kLevelDistance = 0.01;
    const double scale = 1.0 / std::max(source.width, source.height);
    return {scale, -scale * (source.width - 1) / 2, scale * (source.height - 1) / 2,
            k == 0 ? 0.0 : -kLevelDistance * static_cast<double>(k)};
}

std::string json_from_asset(const Asset& asset) {
    if (asset.buffer_length > kMaxBufferBytes)
        throw Error(ErrorKind::kUnsupported, cat("the asset's buffer would have ", asset.buffer_length,
                                                 " bytes, at most ", kMaxBufferBytes));
    tinygltf::Model model = gltf_model(asset);
    const int layers_view =
        asset.has_layers && asset.layers_name.empty() ? add_view(model, asset.layers, 0) : -1;
    const int texture_view = asset.texture_type.empty() ? -1 : add_view(model, asset.texture, 0);
    std::ostringstream text;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, text, /*prettyPrint=*/false, /*writeBinary=*/false);

    json document = json::parse(text.str());
    json buffer = {{"byteLength", asset.buffer_length}};
    if (!asset.buffer_name.empty()) buffer["uri"] = uri_from_name(asset.buffer_name);
    document["buffers"] = json::array({std::move(buffer)});
    if (!asset.meshopt.empty()) add_meshopt(document, asset);
    if (texture_view >= 0) add_texture(document, texture_view, asset.texture_type);
    if (layout_of(asset.source).alpha)
        document["materials"][0]["alphaMode"] = "BLEND";
    else if (texture_view >= 0 && asset.source.has_mask)
        document["materials"][0]["alphaMode"] = "MASK";  // areas below 1/2, the default, are not drawn
    if (asset.has_layers) document["extensions"][kPixelMap] = root_extension(asset, layers_view);
    for (std::size_t k = 0; k < asset.levels.size() && asset.has_layers; ++k) {
        const AssetLevel& level = asset.levels[k];
        if (!std::isfinite(level.error)) throw Error(ErrorKind::kInternal, "a level's error is not finite");
        document["nodes"][k]["extensions"][kPixelMap] = {{"part", level_name(k)},
                                                         {"vertices", level.vertices},
                                                         {"faces", level.faces},
                                                         {"error", level.error},
                                                         {"topology", level.topology}};
    }
    // Names of files among the parameters need not be UTF-8; JSON must be.
    return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace imgmesh
