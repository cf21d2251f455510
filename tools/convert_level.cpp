#include "tools/convert_level.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "formats/export/godot.h"
#include "formats/export/mesh_arrays.h"
#include "formats/export/mesh_export.h"
#include "formats/export/obj.h"
#include "formats/export/outlines.h"
#include "formats/export/spine.h"
#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "formats/files/stream_file.h"
#include "formats/picture/image_io.h"
#include "libcore/image/feature_space.h"
#include "libcore/mesh/disc_parts.h"
#include "libcore/mesh/loop_parts.h"
#include "libcore/mesh/outer_edge.h"
#include "libcore/recon/draw.h"
#include "tools/common/output.h"
#include "tools/common/tool_main.h"

namespace fs = std::filesystem;

namespace imgmesh {
namespace {

// The kinds of each extension, the usual one first. The usual one of an .svg is a drawing of the triangles.
struct KindsOf {
    const char* extension;
    std::vector<ExportKind> kinds;
    bool usual;
};
const std::vector<KindsOf>& kinds_of_extensions() {
    using enum ExportKind;
    static const std::vector<KindsOf> all = {{".json", {kTexturePacker, kSpine, kOutline}, true},
                                             {".tscn", {kPolygon2d, kMeshInstance2d}, true},
                                             {".svg", {kOutline}, false}};
    return all;
}

std::string beside(const std::string& path, const std::string& ending) {
    const fs::path p(path);
    return (p.parent_path() / (p.stem().string() + ending)).string();
}

std::string name_of_file(const std::string& path) {
    return fs::path(path).filename().string();
}

bool is_png(const Texture& texture) {
    return !texture.picture.empty() && texture.picture[0] == 0x89;
}

// Face ids as colours; no face is transparent.
Image id_image(const Level& level, bool has_mask) {
    if (level.mesh.faces.size() > (1u << 24))
        throw Error(ErrorKind::kUnsupported,
                    cat("24 bits hold no ids of ", level.mesh.faces.size(), " faces"));
    Image image = make_image(level.map.width, level.map.height, has_mask ? 4 : 3);
    for (std::size_t i = 0; i < level.map.size(); ++i) {
        const Id face = level.map[i].face;
        float* pixel = image.data.data() + i * static_cast<std::size_t>(image.channels);
        for (int c = 0; c < 3; ++c)
            pixel[c] = face == kNone ? 0 : static_cast<float>(face >> 8 * c & 255) / 255.0f;
        if (has_mask) pixel[3] = face == kNone ? 0 : 1;
    }
    return image;
}

std::string outline_text(const LevelOptions& o, const Level& level, const std::string& generator) {
    Mask mask{level.map.width, level.map.height, {}};
    for (const PixelCoord& coord : level.map) mask.values.push_back(coord.face != kNone);
    const double tolerance = o.outline_tolerance.value_or(0);
    const std::vector<Loop> loops =
        tolerance > 0 ? simplified_outline(mask, tolerance, o.outline_side) : mask_contours(mask);
    const OutlineFacts facts{{mask.width, mask.height}, tolerance, o.outline_side, o.input, generator};
    const auto parts = loop_parts(loops);
    return lower_extension(o.output) == ".svg" ? outline_svg(loops, parts, facts)
                                               : outline_json(loops, parts, facts);
}

// Writes an .obj with its material and image.
void export_textured(const LevelOptions& o, const MeshImage& m, int index, const Texture& texture,
                     bool overwrite) {
    const std::vector<std::string> files = level_files(o, &texture);
    const auto& names = m.source.channel_names;
    const bool soft = std::find(names.begin(), names.end(), "A") != names.end();
    JointFiles joint;
    {
        AtomicFile image(files[2], overwrite);
        image.write(texture.picture);
        image.commit();
    }
    write_text(files[1],
               mtl_of_texture(name_of_file(files[2]), is_png(texture) && (m.source.has_mask || soft)),
               overwrite);
    write_text(files[0],
               textured_obj(m.levels[static_cast<std::size_t>(index)].mesh,
                            texture.coords[static_cast<std::size_t>(index)], name_of_file(files[1])),
               overwrite);
    joint.commit();
}

std::string sprite_text(ExportKind kind, const BaseMesh& mesh, const SourceInfo& source,
                        const std::string& image, const LevelOptions& o, Context& context) {
    if (kind == ExportKind::kTexturePacker)
        return sprite_json_from_mesh(mesh, source, image, context.generator);
    const std::string name = fs::path(o.output).stem().string();
    if (kind == ExportKind::kMeshInstance2d) return godot_mesh(mesh, source, image, name);
    const std::vector<DiscPart> parts = disc_parts(mesh);
    if (kind == ExportKind::kPolygon2d) return godot_polygons(mesh, parts, source, image, name);
    for (const DiscPart& part : parts)
        if (part.vertex.size() > kMostSpineVertices) {
            context.warnings.push_back(cat(o.output, ": a mesh has ", part.vertex.size(),
                                           " vertices, of which Spine's runtimes for the web draw at most ",
                                           kMostSpineVertices, "; a coarser level or an outline has fewer"));
            break;
        }
    return spine_json(mesh, parts, source, image);
}

}  // namespace

const Choices<ExportKind>& export_kinds() {
    static const Choices<ExportKind> kinds = {{"texturepacker", ExportKind::kTexturePacker},
                                              {"spine", ExportKind::kSpine},
                                              {"outline", ExportKind::kOutline},
                                              {"polygon2d", ExportKind::kPolygon2d},
                                              {"meshinstance2d", ExportKind::kMeshInstance2d}};
    return kinds;
}

bool is_level_file(const std::string& output) {
    const std::string extension = lower_extension(output);
    for (const char* name : {".svg", ".ply", ".obj", ".json", ".tscn", ".png", ".npz"})
        if (extension == name) return true;
    return false;
}

std::optional<ExportKind> export_kind(const LevelOptions& o) {
    const std::string extension = lower_extension(o.output);
    for (const KindsOf& kinds : kinds_of_extensions()) {
        if (extension != kinds.extension) continue;
        if (!o.as) return kinds.usual ? std::optional(kinds.kinds[0]) : std::nullopt;
        if (std::find(kinds.kinds.begin(), kinds.kinds.end(), *o.as) != kinds.kinds.end()) return o.as;
    }
    if (o.as) {
        std::string fitting;
        for (const KindsOf& kinds : kinds_of_extensions())
            if (std::find(kinds.kinds.begin(), kinds.kinds.end(), *o.as) != kinds.kinds.end())
                fitting += (fitting.empty() ? "" : " or ") + std::string(kinds.extension);
        throw Error(ErrorKind::kBadArgument, cat("--as ", name_of(export_kinds(), *o.as), ": -o ", o.output,
                                                 " ends otherwise than ", fitting));
    }
    return {};
}

std::vector<std::string> level_files(const LevelOptions& o, const Texture* texture) {
    std::vector<std::string> files = {o.output};
    if (texture) {
        files.push_back(beside(o.output, ".mtl"));
        files.push_back(beside(o.output, is_png(*texture) ? "-texture.png" : "-texture.jpg"));
    } else if (export_kind(o) == ExportKind::kSpine) {
        files.push_back(beside(o.output, ".atlas"));
    }
    return files;
}

void export_level(const LevelOptions& o, const MeshImage& m, int index, const Texture* texture,
                  Context& context) {
    const Level& level = m.levels[static_cast<std::size_t>(index)];
    const std::string extension = lower_extension(o.output);
    const std::optional<ExportKind> kind = export_kind(o);
    if (extension == ".png") {
        write_image(o.output, id_image(level, m.source.has_mask), {context.overwrite, SampleType::kUint8});
        return;
    }
    if (extension == ".npz") {
        write_mesh_arrays(o.output, m, static_cast<std::size_t>(index), context.overwrite);
        return;
    }
    if (texture) {
        export_textured(o, m, index, *texture, context.overwrite);
        return;
    }
    if ((extension == ".ply" || extension == ".obj") && split_names(m.source.channel_names).color.empty())
        throw Error(ErrorKind::kUnsupported, cat(o.input, ": the container has no colour to export"));
    std::string text;
    if (kind == ExportKind::kOutline) {
        text = outline_text(o, level, context.generator);
    } else if (extension == ".svg") {
        text = o.shading == Shading::kGradient ? draw_svg_gradient(m, index)
                                               : draw_svg(m, index, DrawMode::kFlat);
    } else {
        BaseMesh mesh = level.mesh;
        // An outline's mesh has no map, and covers its pixels already.
        if (!o.outline_tolerance) mesh.position = outer_positions(level.mesh, level.map);
        const std::string image =
            o.image.empty() ? fs::path(o.output).filename().replace_extension(".png").string() : o.image;
        if (extension == ".ply")
            text = ply_from_mesh(mesh);
        else if (extension == ".obj")
            text = obj_from_mesh(mesh, m.source);
        else
            text = sprite_text(*kind, mesh, m.source, image, o, context);
        std::error_code error;
        if (kind && !o.image.empty() && stream_descriptor(o.output) < 0 &&
            !fs::exists(fs::path(o.output).parent_path() / o.image, error))
            context.warnings.push_back(cat(o.output, ": names ", o.image, ", which is not beside it"));
        if (kind == ExportKind::kSpine) {
            JointFiles joint;
            write_text(level_files(o, nullptr)[1], spine_atlas(m.source, image), context.overwrite);
            write_text(o.output, text, context.overwrite);
            joint.commit();
            return;
        }
    }
    write_text(o.output, text, context.overwrite);
}

}  // namespace imgmesh
