// imgmesh-convert: a container as another file variant or with another compression, with fewer levels, or in
// another format; a level of a tile set as one mesh.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "formats/container/container.h"
#include "formats/files/extension.h"
#include "formats/files/stream_file.h"
#include "formats/picture/image_io.h"
#include "formats/tileset/tile_set_files.h"
#include "libcore/image/feature_space.h"
#include "libcore/mesh/outer_edge.h"
#include "libcore/mesh/outline_mesh.h"
#include "libcore/pipeline/lean_mesh.h"
#include "libcore/recon/draw.h"
#include "tools/common/compression_options.h"
#include "tools/common/container_input.h"
#include "tools/common/in_file.h"
#include "tools/common/limits.h"
#include "tools/common/memory.h"
#include "tools/common/names.h"
#include "tools/common/output.h"
#include "tools/common/source_image.h"
#include "tools/common/text.h"
#include "tools/common/tool_main.h"
#include "tools/convert_options.h"
#include "tools/tiles/set_convert.h"

using namespace imgmesh;

namespace {

// Reading and writing take this, beside the container itself [bytes a pixel]; measured as in docs/limits.md.
constexpr double kTextureBytes = 46, kImageBytes = 34, kContainerBytes = 24, kTextBytes = 8, kArrayBytes = 14;

// Returns what making the output takes.
double bytes_of_pixel(const ConvertOptions& o) {
    if (is_container(o.output)) return o.texture.wanted.value_or(false) ? kTextureBytes : kContainerBytes;
    const std::string extension = lower_extension(o.output);
    return extension == ".png" ? kImageBytes : extension == ".npz" ? kArrayBytes : kTextBytes;
}

void keep_levels(const ConvertOptions& o, MeshImage& m, Texture& texture) {
    if (o.levels.empty()) return;
    std::vector<Level> kept;
    std::vector<std::vector<Vec2f>> coords;
    for (const int k : o.levels) {
        check_level("--levels", k, o.input, m);
        kept.push_back(std::move(m.levels[static_cast<std::size_t>(k)]));
        if (!texture.coords.empty()) coords.push_back(std::move(texture.coords[static_cast<std::size_t>(k)]));
    }
    texture.coords = std::move(coords);
    // The visit map belongs to the finest level, and is dropped with it.
    if (o.levels.front() != 0) m.visits.clear();
    m.levels = std::move(kept);
}

// Returns the texture of the meshes; `kept` is the existing one. What engines get covers all of its pixels:
// the meshes of a new texture, and those without a pixel map.
Texture chosen_texture(const ConvertOptions& o, MeshImage& m, Texture kept, Context& context) {
    if (!o.texture.wanted && !kept.picture.empty()) return kept;
    if (!o.texture.wanted.value_or(false)) {
        if (o.no_map) cover_whole_pixels(m);
        return {};
    }
    const SourceInfo& source = m.source;
    Image image;
    if (o.image.empty()) {
        if (split_names(source.channel_names).color.empty())
            throw Error(ErrorKind::kUnsupported,
                        cat("--texture: ", o.input, " has no colour; --image names an image that has"));
        image = draw(m, 0, {});
    } else {
        ReadImageOptions options = image_options(o.read, o.limits, context.max_memory);
        options.channels.emplace();              // the colour and alpha
        options.limits.max_pixels_per_byte = 0;  // the container says how many there are
        image = read_source_image(o.image, source, o.input, options, context.warnings);
    }
    Mask mask;
    if (source.has_mask) {
        mask = {source.width, source.height, {}};
        for (const PixelCoord& c : m.levels[0].map) mask.values.push_back(c.face != kNone);
    }
    const auto& names = source.channel_names;
    const bool soft = std::find(names.begin(), names.end(), "A") != names.end();
    if (o.no_map)
        cover_whole_pixels(m);
    else
        extend_to_outer_edge(m);
    return in_file(o.image.empty() ? o.input : o.image, [&] {
        return Texture{
            encode_texture(image, mask, o.texture.type, soft ? TextureAlpha::kOwn : TextureAlpha::kMask),
            texture_coords(m)};
    });
}

// Makes the meshes compact as far as their map and their compression allow, and says where they do not.
void compact(const ConvertOptions& o, MeshImage& m, ContainerOptions& options,
             std::vector<std::string>& warnings) {
    const bool own_places = !options.texture.picture.empty() && options.texture.coords == texture_coords(m);
    make_compact(m, options.layers != LayerLayout::kOff);
    if (own_places) options.texture.coords = texture_coords(m);
    if (options.layers != LayerLayout::kOff)
        warnings.push_back(cat(o.input,
                               ": --mesh-precision compact: positions stay, because the pixel map lies on "
                               "them; imgmesh-build --mesh-precision compact makes them coarser as well"));
    if (options.draco == DracoMode::kOff && !options.meshopt)
        warnings.push_back(cat(o.input,
                               ": --mesh-precision compact: meshes without compression take the same bytes; "
                               "--compression draco makes them smaller"));
}

// An image is put on a mesh by where its vertices lie, which is where they were before imgmesh-warp.
void check_places(const ConvertOptions& o, const MeshImage& m) {
    const std::optional<ExportKind> kind = export_kind(level_options(o));
    const bool sprite = kind && kind != ExportKind::kOutline && !o.outline_tolerance;
    if (!m.generator.starts_with("imgmesh-warp") || (!sprite && !o.texture.wanted.value_or(false))) return;
    throw Error(ErrorKind::kUnsupported,
                cat(o.input,
                    ": imgmesh-warp has moved its vertices, so they no longer tell where in the image "
                    "they belong; a texture that is there before, by imgmesh-build --texture, moves "
                    "along into containers and .obj"));
}

// Returns how the pixel maps are stored; `kept` is how they are. With a new texture meshes are stretched, and
// pixels leave their grid.
LayerLayout chosen_layers(const ConvertOptions& o, LayerLayout kept) {
    if (o.no_map || o.outline_tolerance) return LayerLayout::kOff;
    const bool stretched = o.texture.wanted.value_or(false);
    return o.compression.layers.value_or(stretched ? LayerLayout::kExr : kept);
}

void check_options(const ConvertOptions& o) {
    is_tile_set(o.input) ? check_set_options(o) : check_convert_options(o);
}

Report convert_one(const ConvertOptions& given, Context& context) {
    ConvertOptions o = given;
    if (is_tile_set(o.input)) return convert_set(o, context);
    const bool obj = lower_extension(o.output) == ".obj";
    if (obj && !o.image.empty()) o.texture.wanted = true;
    check_output(o.output, context.overwrite);
    context.progress(0, "read");
    Container container = read_container(o.input, container_limits(o.limits, context.max_memory));
    MeshImage& m = container.mesh_image;
    check_places(o, m);
    const LayerLayout layers = chosen_layers(o, container.facts.layout);
    if (is_container(o.output) && layers == LayerLayout::kExr && !o.compression.layers &&
        container.facts.layout == LayerLayout::kCompact)
        context.warnings.push_back(cat(o.input,
                                       ": the texture's meshes are stretched, so that pixels leave the "
                                       "grid of compact layers, and ",
                                       o.output, " has an EXR"));
    check_distinct(container.facts.files, {o.output});
    if (is_container(o.output) && o.texture.wanted.value_or(false) && !o.image.empty())
        check_distinct({o.image}, container_files(o.output, layers));
    int level = o.level.value_or(0);
    WrittenContainer written;
    std::vector<std::string>& files = written.files;
    check_level("--level", level, o.input, m);
    context.memory.take_for(o.input, m, bytes_of_pixel(o));
    context.progress(0.5, "write");
    ContainerOptions options;
    const auto outline = [&] { m = outline_mesh_image(m, level, *o.outline_tolerance, o.outline_side); };
    if (is_container(o.output)) {
        options.metadata = container.metadata;
        options.texture = chosen_texture(o, m, std::move(container.texture), context);
        keep_levels(o, m, options.texture);
        options.overwrite = context.overwrite;
        options.keep = container.facts.files;
        options.layers = layers;
        compress(options, o.compression,
                 layers != LayerLayout::kOff ? container.facts.draco : DracoMode::kOff);
        if (o.outline_tolerance) {
            if (options.texture.picture.empty())
                throw Error(ErrorKind::kBadArgument,
                            cat("--outline-tolerance: ", o.input, " has no texture; --texture makes one"));
            outline();
            options.texture.coords = texture_coords(m);
        }
        if (o.precision == MeshPrecision::kCompact) compact(o, m, options, context.warnings);
        written = write_container(o.output, m, options);
    } else {
        const LevelOptions exported = level_options(o);
        const bool outline_mesh = o.outline_tolerance && export_kind(exported) != ExportKind::kOutline;
        if (obj) options.texture = chosen_texture(o, m, std::move(container.texture), context);
        if (outline_mesh) {
            outline();
            if (obj && !options.texture.picture.empty()) options.texture.coords = texture_coords(m);
        }
        const Texture* texture = options.texture.picture.empty() ? nullptr : &options.texture;
        files = level_files(exported, texture);
        if (files.size() > 1 && stream_descriptor(o.output) >= 0)
            throw Error(
                ErrorKind::kBadArgument,
                texture ? "-o -: an .obj with a texture needs files beside it; --no-texture leaves that out"
                        : "-o -: a Spine skeleton needs its atlas beside it, so its output must be a file");
        for (const std::string& file : files) check_output(file, context.overwrite);
        check_distinct(container.facts.files, files);
        if (!o.image.empty()) check_distinct({o.image}, files);
        if (outline_mesh) level = 0;
        export_level(exported, m, level, texture, context);
    }
    const Level& first = m.levels[is_container(o.output) ? 0 : static_cast<std::size_t>(level)];
    Report report = {{"input", o.input},
                     {"output", o.output},
                     {"levels", is_container(o.output) ? m.levels.size() : 1},
                     {"level", is_container(o.output) ? 0 : o.level.value_or(0)},
                     {"vertices", first.mesh.vertex_count()},
                     {"faces", first.mesh.faces.size()},
                     {"layers", is_container(o.output) && layers != LayerLayout::kOff},
                     {"texture", !options.texture.picture.empty()},
                     {"bytes", size_of_files(files)}};
    if (is_container(o.output)) {
        report["mesh_bytes"] = written.mesh_bytes;
        report["layer_bytes"] = written.layer_bytes;
        if (layers != LayerLayout::kOff) report["layer_layout"] = name_of(layer_choices(), layers);
    }
    if (files.size() > 1) report["outputs"] = files;
    return report;
}

void print(const Report& report, std::ostream& out) {
    out << printable_line(report["input"].get<std::string>() + " -> " + report["output"].get<std::string>())
        << '\n';
    TextTable table;
    table.add("levels", cat(report["levels"], report["layers"] ? ", with pixel maps" : "",
                            report["texture"] ? ", with a texture" : ""));
    table.add("mesh", cat(report["vertices"], " vertices, ", report["faces"], " faces"));
    table.add("file", format_bytes(report["bytes"].get<std::uint64_t>()));
    if (report.contains("outputs"))
        for (std::size_t i = 1; i < report["outputs"].size(); ++i)
            table.add(i == 1 ? "beside it" : "", printable_line(report["outputs"][i].get<std::string>()));
    table.print(out, 2);
}

std::string line(const Report& report) {
    return cat(report["vertices"], " vertices, ", report["faces"], " faces, ",
               format_bytes(report["bytes"].get<std::uint64_t>()));
}

}  // namespace

int main(int argc, char** argv) {
    ConvertOptions options;
    return tool_main<ConvertOptions>(
        {.name = "imgmesh-convert",
         .description =
             "Turn containers and levels of tile sets into another file variant, compression or format.",
         .input_name = "CONTAINER",
         .input_help = "Containers to read (.glb, .gltf), or folders of tile sets",
         .output_help =
             "Container to write (.glb, .gltf), or a level of it as .svg, .ply, .obj, .json (a sprite's "
             "mesh), .tscn (a scene for Godot), .npz (arrays for numpy) or .png (24-bit face ids, red the "
             "low "
             "byte); or a folder, ended by /, for NAME.glb of each container",
         .type = [] { return "glb"; },
         .sources = {"--image"}},
        {add_convert_options, check_options, convert_one, print, line}, options, argc, argv);
}
