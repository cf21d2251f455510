// open() and save(): containers as files of JavaScript.
#include <emscripten/bind.h>

#include "formats/container/container.h"
#include "formats/files/extension.h"
#include "libcore/base/error.h"
#include "libcore/mesh/outer_edge.h"
#include "web/engine/file_folder.h"
#include "web/engine/guarded.h"
#include "web/engine/mesh_files.h"
#include "web/engine/mesh_value.h"
#include "web/engine/pixels.h"

namespace imgmesh::web {
namespace {

bool is_container(const std::string& name) {
    const std::string extension = lower_extension(name);
    return extension == ".glb" || extension == ".gltf";
}

// files   an array of { name, bytes }: a .glb, or a .gltf and the files that it names
// limits  { pixels }: of all levels together; undefined for the usual limit
MeshPointer open_container(const val& files) {
    return guarded([&] {
        FileFolder folder;
        std::string name;
        for (int i = 0, count = files["length"].as<int>(); i < count; ++i) {
            const auto file = files[i]["name"].as<std::string>();
            folder.add(file, files[i]["bytes"]);
            if (!is_container(file)) continue;
            if (!name.empty())
                throw Error(ErrorKind::kBadArgument,
                            cat(name, " and ", file, ": one container can be opened at a time"));
            name = file;
        }
        if (name.empty())
            throw Error(ErrorKind::kBadArgument,
                        "a container's name ends with .glb or .gltf, and there is none");
        Container container = read_container(name);
        const auto mesh = std::make_shared<MeshValue>();
        mesh->mesh_image = std::move(container.mesh_image);
        mesh->texture = std::move(container.texture);
        mesh->metadata = std::move(container.metadata);
        mesh->draco = container.facts.draco;
        mesh->layers = container.facts.layout;
        return mesh;
    });
}

template <typename T>
T chosen(const val& options, const char* name, T otherwise,
         std::initializer_list<std::pair<const char*, T>> choices) {
    const val value = options[name];
    if (value.isUndefined()) return otherwise;
    const std::string word = value.isString() ? value.as<std::string>() : "";
    std::string list;
    for (const auto& [known, meaning] : choices) {
        if (word == known) return meaning;
        list += (list.empty() ? "" : ", ") + std::string(known);
    }
    throw Error(ErrorKind::kBadArgument, cat(name, " '", word, "': expected one of ", list));
}

// The mesh image with a new texture: its meshes reach to the pixels' outer edge, as imgmesh-build --texture
// makes them. A map on a grid would leave it.
void put_texture(const val& bytes, bool has_map, MeshImage& m, ContainerOptions& options) {
    if (m.generator.starts_with("imgmesh-warp"))
        throw Error(ErrorKind::kUnsupported,
                    "texture: the vertices have been moved, so they no longer tell where in the image they "
                    "belong");
    if (has_map && options.layers == LayerLayout::kCompact)
        throw Error(
            ErrorKind::kBadArgument,
            "layers 'compact' and texture: the meshes of a texture are stretched, so that pixels leave "
            "the grid that compact layers need; expected 'exr'");
    if (has_map)
        extend_to_outer_edge(m);
    else
        cover_whole_pixels(m);
    options.texture = {bytes_from(bytes), texture_coords(m)};
}

}  // namespace

// given  { name, layers, draco, texture }; see SaveOptions in web/package/src/container.ts
val save_container(const MeshValue& mesh, const val& given) {
    return guarded([&] {
        const std::string name = given["name"].isString() ? given["name"].as<std::string>() : "";
        check_file_name(name);
        ContainerOptions options;
        const val texture = given["texture"];
        const bool is_new = !texture.isUndefined() && !texture.isNull();
        options.layers = chosen(given, "layers", is_new ? LayerLayout::kExr : mesh.layers,
                                {std::pair("compact", LayerLayout::kCompact),
                                 std::pair("exr", LayerLayout::kExr), std::pair("none", LayerLayout::kOff)});
        const bool has_map = options.layers != LayerLayout::kOff;
        options.draco =
            chosen(given, "draco", has_map ? mesh.draco : DracoMode::kOff,
                   {std::pair("edgebreaker", DracoMode::kEdgebreaker),
                    std::pair("sequential", DracoMode::kSequential), std::pair("none", DracoMode::kOff)});
        options.metadata = mesh.metadata;
        const FileFolder folder;
        if (!is_new && (has_map || !mesh.texture.picture.empty())) {
            options.texture = mesh.texture;
            return folder.files(write_container(name, mesh.mesh_image, options).files);
        }
        MeshImage changed = mesh.mesh_image;
        if (is_new)
            put_texture(texture, has_map, changed, options);
        else
            cover_whole_pixels(changed);
        return folder.files(write_container(name, changed, options).files);
    });
}

EMSCRIPTEN_BINDINGS(imgmesh_container) {
    emscripten::function("open", open_container);
}

}  // namespace imgmesh::web
