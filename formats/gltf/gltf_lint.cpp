// Source: glTF 2.0 specification; docs/format.md for how levels are laid out.
#include "formats/gltf/gltf_lint.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "formats/findings/findings.h"
#include "formats/findings/json_members.h"
#include "formats/gltf/gltf_names.h"
#include "formats/gltf/gltf_texture.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using nlohmann::json;

const json kNothing;

// Returns members[index] of an array, or null if there is none.
const json& element(const json& members, std::uint64_t index) {
    return members.is_array() && index < members.size() ? members[index] : kNothing;
}
const json& child(const json& object, const char* name) {
    const json* value = find(object, name);
    return value ? *value : kNothing;
}
const json& extension(const json& object, const char* name) {
    return child(child(object, "extensions"), name);
}
bool contains(const json& names, const std::string& name) {
    return names.is_array() && std::find(names.begin(), names.end(), name) != names.end();
}
std::uint64_t offset_of(const json& object) {
    const json& offset = child(object, "byteOffset");
    return offset.is_number_unsigned() ? offset.get<std::uint64_t>() : 0;
}

void collect_extensions(const json& value, std::set<std::string>& names) {
    if (!value.is_structured()) return;
    for (const auto& [name, item] : value.items()) {
        if (value.is_object() && name == "extensions" && item.is_object())
            for (const auto& used : item.items()) names.insert(used.key());
        collect_extensions(item, names);
    }
}

void lint_extensions(const json& document, const Asset& asset, Findings& findings) {
    std::set<std::string> names;
    collect_extensions(document, names);
    for (const std::string& name : names)
        if (!contains(child(document, "extensionsUsed"), name))
            findings.add("gltf.used", cat(name, " is used, but not listed"), at_pointer("/extensionsUsed"));
    const json& required = child(document, "extensionsRequired");
    const bool draco = std::any_of(asset.levels.begin(), asset.levels.end(),
                                   [](const AssetLevel& level) { return level.is_draco; });
    if (draco && !contains(required, kDraco))
        findings.add("gltf.draco_optional", cat(kDraco, " is not required"),
                     at_pointer("/extensionsRequired"));
    if (contains(required, kPixelMap))
        findings.add("gltf.pixel_map_required", cat(kPixelMap, " is required"),
                     at_pointer("/extensionsRequired"));
}

// Differences too small for any viewer do not count.
bool is_near(const json& numbers, std::initializer_list<double> expected) {
    if (!numbers.is_array() || numbers.size() != expected.size()) return false;
    return std::equal(expected.begin(), expected.end(), numbers.begin(), [](double want, const json& found) {
        return found.is_number() &&
               std::abs(found.get<double>() - want) <= 1e-6 * std::max(1.0, std::abs(want));
    });
}

void lint_node(const json& node, const SourceInfo& source, std::size_t k, const std::string& pointer,
               Findings& findings) {
    const auto [scale, x, y, z] = node_place(source, k);
    const bool centred = !node.contains("matrix") && !node.contains("rotation") &&
                         is_near(child(node, "scale"), {scale, scale, scale}) &&
                         is_near(child(node, "translation"), {x, y, z});
    if (!centred)
        findings.add("gltf.transform", cat("level ", k, " is placed elsewhere"), at_pointer(pointer));
}

void lint_level(const json& document, const Asset& asset, std::size_t k, Findings& findings) {
    const LevelPlace& place = asset.places[k];
    const std::string at_node = cat("/nodes/", place.node), at_mesh = cat("/meshes/", place.mesh);
    const json& node = element(child(document, "nodes"), place.node);
    const json& mesh = element(child(document, "meshes"), place.mesh);
    if (child(node, "name") != level_name(k))
        findings.add("gltf.names", cat("the node is not named ", level_name(k)), at_pointer(at_node));
    lint_node(node, asset.source, k, at_node, findings);
    if (!asset.levels[k].is_sound) return;
    if (child(mesh, "name") != level_name(k) + "-mesh")
        findings.add("gltf.names", cat("the mesh is not named ", level_name(k), "-mesh"),
                     at_pointer(at_mesh));

    const json& primitive = element(child(mesh, "primitives"), 0);
    const json& index = child(primitive, "material");
    const json& material = index.is_number_unsigned()
                               ? element(child(document, "materials"), index.get<std::uint64_t>())
                               : kNothing;
    if (!extension(material, kUnlit).is_object() || child(material, "doubleSided") != true)
        findings.add("gltf.material", cat("level ", k, " is lit or has one side"),
                     at_pointer(at_mesh + "/primitives/0/material"));
    for (const auto& [name, accessor] : child(primitive, "attributes").items())
        if (name != "POSITION" && name != "COLOR_0" && name != "TEXCOORD_0" && !name.starts_with('_'))
            findings.add("gltf.foreign", cat("attribute ", name, " is not read"),
                         at_pointer(at_mesh + "/primitives/0/attributes/" + pointer_token(name)));
    lint_texture(document, asset, k, findings);
    if (k == 0) return;
    const AssetLevel &finer = asset.levels[k - 1], &level = asset.levels[k];
    if (finer.is_sound && (level.faces > finer.faces || level.error < finer.error))
        findings.add("ext.order",
                     cat("level ", k, " has ", level.faces, " faces and error ", level.error,
                         ", the one before ", finer.faces, " and ", finer.error),
                     at_pointer(cat(at_node, "/extensions/", kPixelMap)));
    if (finer.is_sound && level.is_draco != finer.is_draco)
        findings.add("draco.mixed", cat("level ", k, " is stored otherwise than the one before"),
                     at_pointer(at_mesh));
}

void lint_scenes(const json& document, const Asset& asset, Findings& findings) {
    const json& scene = child(document, "scene");
    const json& shown = scene.is_number_unsigned()
                            ? child(element(child(document, "scenes"), scene.get<std::uint64_t>()), "nodes")
                            : kNothing;
    if (shown != json::array({asset.places[0].node}))
        findings.add("gltf.scene", "the default scene is not level 0 alone", at_pointer("/scene"));
    json coarser = json::array();
    for (std::size_t k = 1; k < asset.places.size(); ++k) coarser.push_back(asset.places[k].node);
    const json& node = element(child(document, "nodes"), asset.places[0].node);
    const json& listed = child(extension(node, "MSFT_lod"), "ids");
    if (coarser.empty() ? !listed.is_null() : listed != coarser)
        findings.add("gltf.lod", cat("MSFT_lod lists ", listed.dump(), ", expected ", coarser.dump()),
                     at_pointer(cat("/nodes/", asset.places[0].node)));
}

void lint_members(const json& document, const Asset& asset, Findings& findings) {
    const auto unknown = [&](const json& object, const std::string& pointer,
                             std::initializer_list<const char*> known) {
        if (!object.is_object()) return;
        for (const auto& item : object.items())
            if (std::find(known.begin(), known.end(), item.key()) == known.end() && item.key() != "extras" &&
                item.key() != "extensions")
                findings.add("ext.unknown", cat("\"", item.key(), "\" is ignored"),
                             at_pointer(pointer + "/" + pointer_token(item.key())));
    };
    const json& root = extension(document, kPixelMap);
    const std::string at_root = cat("/extensions/", kPixelMap);
    unknown(root, at_root, {"version", "image", "layers", "build"});
    unknown(child(root, "image"), at_root + "/image",
            {"width", "height", "colorSpace", "sampleType", "channels", "hasMask", "metadata"});
    unknown(child(root, "layers"), at_root + "/layers", {"bufferView", "uri", "mimeType"});
    for (const LevelPlace& place : asset.places)
        unknown(extension(element(child(document, "nodes"), place.node), kPixelMap),
                cat("/nodes/", place.node, "/extensions/", kPixelMap),
                {"part", "vertices", "faces", "error", "topology"});
}

void lint_views(const json& document, Findings& findings) {
    struct View {
        std::uint64_t begin, end, index;
    };
    std::vector<View> views;
    const json& list = child(document, "bufferViews");
    for (std::uint64_t i = 0; list.is_array() && i < list.size(); ++i) {
        const json& length = child(list[i], "byteLength");
        const std::uint64_t begin = offset_of(list[i]);
        if (length.is_number_unsigned()) views.push_back({begin, begin + length.get<std::uint64_t>(), i});
    }
    std::sort(views.begin(), views.end(), [](const View& a, const View& b) {
        return std::tie(a.begin, a.index) < std::tie(b.begin, b.index);
    });
    for (std::size_t i = 1; i < views.size(); ++i)
        if (views[i].begin < views[i - 1].end)
            findings.add("gltf.overlap",
                         cat("bufferViews ", views[i - 1].index, " and ", views[i].index, " share bytes"),
                         at_pointer(cat("/bufferViews/", views[i].index)));
    const json& accessors = child(document, "accessors");
    for (std::uint64_t i = 0; accessors.is_array() && i < accessors.size(); ++i) {
        const json& view = child(accessors[i], "bufferView");
        if (!view.is_number_unsigned()) continue;
        const std::uint64_t offset =
            offset_of(element(list, view.get<std::uint64_t>())) + offset_of(accessors[i]);
        if (offset % 4 != 0)
            findings.add("gltf.alignment", cat("accessor ", i, " starts at byte ", offset),
                         at_pointer(cat("/accessors/", i)));
    }
}

// Every "bufferView" counts as a reference wherever it is; references to accessors are in primitives.
void collect_views(const json& value, std::set<std::uint64_t>& used) {
    if (!value.is_structured()) return;
    for (const auto& [name, item] : value.items()) {
        if (value.is_object() && name == "bufferView" && item.is_number_unsigned())
            used.insert(item.get<std::uint64_t>());
        collect_views(item, used);
    }
}

void lint_unused(const json& document, Findings& findings) {
    std::set<std::uint64_t> views, accessors;
    collect_views(document, views);
    for (const json& mesh : child(document, "meshes"))
        for (const json& primitive : child(mesh, "primitives")) {
            if (child(primitive, "indices").is_number_unsigned())
                accessors.insert(primitive["indices"].get<std::uint64_t>());
            for (const json& index : child(primitive, "attributes"))
                if (index.is_number_unsigned()) accessors.insert(index.get<std::uint64_t>());
        }
    const auto tell = [&](const char* name, const std::set<std::uint64_t>& used) {
        const json& list = child(document, name);
        for (std::uint64_t i = 0; list.is_array() && i < list.size(); ++i)
            if (!used.count(i))
                findings.add("gltf.unused", "nothing refers to it", at_pointer(cat('/', name, '/', i)));
    };
    tell("accessors", accessors);
    tell("bufferViews", views);
}

void lint_foreign(const json& document, const Asset& asset, Findings& findings) {
    for (const char* name : {"animations", "skins", "cameras"})
        if (document.contains(name))
            findings.add("gltf.foreign", cat(name, " are not read"), at_pointer(cat('/', name)));
    const json& layers = child(extension(document, kPixelMap), "layers");
    const json& images = child(document, "images");
    for (std::uint64_t i = 0; images.is_array() && i < images.size(); ++i) {
        const auto same = [&](const char* name) {
            return !child(images[i], name).is_null() && child(images[i], name) == child(layers, name);
        };
        if (same("mimeType") || same("uri") || same("bufferView"))
            findings.add("gltf.image", cat("image ", i, " holds the layers"), at_pointer(cat("/images/", i)));
    }
    if (!asset.buffer_name.empty() && asset.buffer_name == asset.layers_name)
        findings.add("uri.same", cat("buffer and layers are both in ", asset.buffer_name),
                     at_pointer(cat("/extensions/", kPixelMap, "/layers/uri")));
}

}  // namespace

void lint_gltf(const json& document, const Asset& asset, Findings& findings) {
    lint_extensions(document, asset, findings);
    lint_members(document, asset, findings);
    lint_views(document, findings);
    // A wrong reference has been reported already; its intended target has not.
    if (findings.errors() == 0) lint_unused(document, findings);
    lint_foreign(document, asset, findings);
    if (!asset.has_levels) return;
    lint_scenes(document, asset, findings);
    for (std::size_t k = 0; k < asset.levels.size(); ++k) lint_level(document, asset, k, findings);
}

}  // namespace imgmesh
