// Files of other programs, as imgmesh-convert and imgmesh-segment write them.
#include <emscripten/bind.h>

#include <algorithm>

#include "formats/export/label_files.h"
#include "formats/export/mesh_export.h"
#include "formats/export/obj.h"
#include "formats/gltf/gltf_texture.h"
#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"
#include "libcore/mesh/outer_edge.h"
#include "web/engine/file_folder.h"
#include "web/engine/guarded.h"
#include "web/engine/mesh_files.h"
#include "web/engine/pixels.h"

namespace imgmesh::web {
namespace {

// The program that a sprite's file names: the bytes are the same whoever called the libraries.
constexpr char kConvert[] = "imgmesh-convert " IMGMESH_VERSION;

val text_file(const std::string& name, const std::string& text) {
    val file = val::object();
    file.set("name", name);
    file.set("bytes", typed_array(std::vector<std::uint8_t>(text.begin(), text.end()), "Uint8Array"));
    return file;
}

// pixels  { width, height, data }, 8 bits a sample
val encode_png_file(const val& pixels) {
    return guarded([&] {
        return typed_array(encode_image("x.png", image_from_pixels(pixels), SampleType::kUint8),
                           "Uint8Array");
    });
}

}  // namespace

std::string export_text(const MeshValue& mesh, const std::string& format, int index,
                        const std::string& image) {
    return guarded([&] {
        const MeshImage& m = mesh.mesh_image;
        const Level& level = mesh.level(index);
        const bool sprite = format == "json";
        if (!sprite && format != "ply" && format != "obj")
            throw Error(ErrorKind::kBadArgument,
                        cat("format '", format, "': expected one of ply, obj, json"));
        if (sprite && m.generator.starts_with("imgmesh-warp"))
            throw Error(
                ErrorKind::kUnsupported,
                "the vertices have been moved, so they no longer tell where in the image they belong");
        if (!sprite && split_names(m.source.channel_names).color.empty())
            throw Error(ErrorKind::kUnsupported, "the mesh has no colour to export");
        BaseMesh outer = level.mesh;
        outer.position = outer_positions(level.mesh, level.map);
        if (format == "ply") return ply_from_mesh(outer);
        if (format == "obj") return obj_from_mesh(outer, m.source);
        return sprite_json_from_mesh(outer, m.source, image, kConvert);
    });
}

val export_textured(const MeshValue& mesh, const std::string& name, int level, const val& given) {
    return guarded([&] {
        check_file_name(name);
        mesh.level(level);
        const bool is_new = !given.isUndefined() && !given.isNull();
        if (!is_new && mesh.texture.picture.empty())
            throw Error(ErrorKind::kBadArgument,
                        "texture: the mesh has none, expected the bytes of a PNG or JPEG");
        if (is_new && mesh.mesh_image.generator.starts_with("imgmesh-warp"))
            throw Error(
                ErrorKind::kUnsupported,
                "the vertices have been moved, so they no longer tell where in the image they belong");
        MeshImage m = mesh.mesh_image;
        Texture texture = mesh.texture;
        if (is_new) {
            extend_to_outer_edge(m);
            texture = {bytes_from(given), texture_coords(m)};
        }
        const std::string type = picture_type(texture.picture);
        if (type.empty())
            throw Error(ErrorKind::kBadArgument, "texture: expected the bytes of a PNG or JPEG file");
        const std::string picture = name + (type == "image/png" ? "-texture.png" : "-texture.jpg");
        const bool soft = std::ranges::count(m.source.channel_names, "A") > 0;
        const auto k = static_cast<std::size_t>(level);
        val files = val::array(), image = val::object();
        files.call<void>("push", text_file(name + ".obj",
                                           textured_obj(m.levels[k].mesh, texture.coords[k], name + ".mtl")));
        files.call<void>(
            "push", text_file(name + ".mtl",
                              mtl_of_texture(picture, type == "image/png" && (m.source.has_mask || soft))));
        image.set("name", picture);
        image.set("bytes", typed_array(texture.picture, "Uint8Array"));
        files.call<void>("push", image);
        return files;
    });
}

val export_labels(const std::string& name, int width, int height, const val& labels) {
    return guarded([&] {
        check_file_name(name);
        const double count = double(width) * height;
        if (!(width >= 1 && height >= 1 && labels["length"].as<double>() == count))
            throw Error(ErrorKind::kBadArgument,
                        cat("labels: expected ", count, " for ", width, "x", height, " pixels"));
        std::vector<Id> values(static_cast<std::size_t>(count));
        val(emscripten::typed_memory_view(values.size(), values.data())).call<void>("set", labels);
        const FileFolder folder;
        write_labels(name, width, height, values, true);
        return folder.bytes(name);
    });
}

EMSCRIPTEN_BINDINGS(imgmesh_export) {
    emscripten::function("encodePng", encode_png_file);
    emscripten::function("exportLabels", export_labels);
}

}  // namespace imgmesh::web
