// imgmesh-convert: a container as another file variant or with another compression, with fewer levels, or in
// another format.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "formats/container/container.h"
#include "formats/export/mesh_export.h"
#include "formats/files/extension.h"
#include "formats/picture/image_io.h"
#include "libcore/image/feature_space.h"
#include "libcore/mesh/outer_edge.h"
#include "libcore/mesh/outline_mesh.h"
#include "libcore/recon/draw.h"
#include "tools/common/container_input.h"
#include "tools/common/in_file.h"
#include "tools/common/limits.h"
#include "tools/common/memory.h"
#include "tools/common/names.h"
#include "tools/common/options.h"
#include "tools/common/output.h"
#include "tools/common/read_options.h"
#include "tools/common/source_image.h"
#include "tools/common/text.h"
#include "tools/common/texture_options.h"
#include "tools/common/tool_main.h"

namespace fs = std::filesystem;
using namespace imgmesh;

namespace {

// Reading and writing take this, beside the container itself [bytes a pixel]; measured as in docs/limits.md.
constexpr double kTextureBytes = 46, kImageBytes = 34, kContainerBytes = 24, kTextBytes = 8;

// More than a container can have; its own number is checked when it has been read.
constexpr CountRange kLevelRange = {0, 1000};

// Beyond, a sprite's outline is no longer its own.
constexpr double kMostTolerance = 64;

enum class Shading { kFlat, kGradient };

struct Options {
    std::string input;
    std::string output;
    std::optional<DracoMode> draco;
    std::vector<int> levels;
    bool no_layers = false;
    TextureOptions texture;
    std::optional<int> level;
    std::optional<Shading> shading;
    std::optional<double> outline_tolerance;
    OutlineSide outline_side = OutlineSide::kOut;
    std::string image;
    ReadImageOptions read;
    ContainerLimits limits;
};

void add_options(CLI::App& app, Options& o) {
    const std::string container = "Container", level = "Level";
    in_group(add_choice(app, "--draco", o.draco, draco_choices(),
                        {"Compression of the meshes", "that of the input"}),
             container);
    in_group(
        add_value(app, "--levels", "LIST",
                  [&o](const std::string& text) {
                      o.levels.clear();
                      for (const std::string& item : split_list(text))
                          o.levels.push_back(static_cast<int>(parse_count("--levels", item, kLevelRange)));
                  },
                  {"Levels to keep, the finest first, as in 0,2; they are numbered anew", "all"}),
        container);
    in_group(add_flag(
                 app, "--no-layers", [&o] { o.no_layers = true; },
                 "Write the meshes alone: a plain glTF asset that imgmesh cannot read"),
             container);
    add_texture_options(app, o.texture,
                        {"Put an image on the meshes, for engines and viewers: that of --image, or else the "
                         "reconstruction",
                         "the input's texture, if it has one"},
                        true);
    in_group(add_count(app, "--level", o.level, kLevelRange, {"Level to export, 0 the finest", "0"}), level);
    in_group(add_choice(app, "--shading", o.shading,
                        Choices<Shading>{{"flat", Shading::kFlat}, {"gradient", Shading::kGradient}},
                        {"Shading of an .svg's triangles", "flat"}),
             level);
    CLI::Option* const tolerance = in_group(
        add_number(
            app, "--outline-tolerance", o.outline_tolerance, {0, kMostTolerance},
            {"Make the mesh of a sprite (.json, .obj, or a container with a texture) from its outline alone, "
             "which may lie this many pixels from the image's",
             "none: the base mesh"}),
        level);
    CLI::Option* const side =
        add_choice(app, "--outline-side", o.outline_side,
                   Choices<OutlineSide>{{"out", OutlineSide::kOut}, {"both", OutlineSide::kBoth}},
                   "Where that outline may lie: outside alone, where it cuts no pixel, or on both sides");
    in_group(needs(side, tolerance), level);
    CLI::Option* const image =
        add_value(app, "--image", "NAME", [&o](const std::string& text) { o.image = text; },
                  {"Image that --texture puts on the meshes, or that a sprite's .json names",
                   "the output's name in .png"});
    add_read_options(app, o.read, image, true);
    add_container_limits(app, o.limits);
}

// Throws Error(kBadArgument) for mistakes that can be found before the container is read.
void check_options(const Options& o) {
    const std::string extension = lower_extension(o.output);
    const auto only_for = [&](bool given, const char* option, bool fits, const char* what) {
        if (given && !fits)
            throw Error(ErrorKind::kBadArgument, cat(option, ": -o ", o.output, " is no ", what));
    };
    const bool container = is_container(o.output);
    bool known = container;
    for (const char* name : {".svg", ".ply", ".obj", ".json", ".png"}) known = known || extension == name;
    if (!known)
        throw Error(
            ErrorKind::kBadArgument,
            cat("-o ", o.output, ": expected a name in .glb, .gltf, .svg, .ply, .obj, .json or .png"));
    only_for(o.draco.has_value(), "--draco", container, "container");
    only_for(!o.levels.empty(), "--levels", container, "container");
    only_for(o.no_layers, "--no-layers", container, "container");
    only_for(o.texture.wanted.has_value(), "--texture", container, "container");
    if (container && o.level)
        throw Error(ErrorKind::kBadArgument, cat("--level: ", o.output, " keeps all levels; see --levels"));
    only_for(o.shading.has_value(), "--shading", extension == ".svg", "SVG");
    if (container && !o.image.empty() && !o.texture.wanted.value_or(false))
        throw Error(ErrorKind::kBadArgument, "--image: of use to a container only with --texture");
    only_for(!o.image.empty(), "--image", container || extension == ".json", "container or sprite's JSON");
    only_for(o.outline_tolerance.has_value(), "--outline-tolerance",
             container || extension == ".obj" || extension == ".json", "container, .obj or .json");
    if (o.outline_tolerance && !o.levels.empty())
        throw Error(ErrorKind::kBadArgument, "--outline-tolerance and --levels: an outline has one level");
    if (o.outline_tolerance && container && !o.texture.wanted.value_or(true))
        throw Error(ErrorKind::kBadArgument,
                    "--outline-tolerance and --no-texture: an outline shows nothing without a texture");
    for (std::size_t i = 1; i < o.levels.size(); ++i)
        if (o.levels[i] <= o.levels[i - 1])
            throw Error(ErrorKind::kBadArgument, cat("--levels: ", o.levels[i], " after ", o.levels[i - 1],
                                                     ", expected the finest first and each once"));
}

// Returns what making the output takes.
double bytes_of_pixel(const Options& o) {
    if (is_container(o.output)) return o.texture.wanted.value_or(false) ? kTextureBytes : kContainerBytes;
    return lower_extension(o.output) == ".png" ? kImageBytes : kTextBytes;
}

void keep_levels(const Options& o, MeshImage& m, Texture& texture) {
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
Texture chosen_texture(const Options& o, MeshImage& m, Texture kept, Context& context) {
    if (!o.texture.wanted && !kept.picture.empty()) return kept;
    if (!o.texture.wanted.value_or(false)) {
        if (o.no_layers) extend_to_outer_edge(m);
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
    extend_to_outer_edge(m);
    return in_file(o.image.empty() ? o.input : o.image, [&] {
        return Texture{
            encode_texture(image, mask, o.texture.type, soft ? TextureAlpha::kOwn : TextureAlpha::kMask),
            texture_coords(m)};
    });
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

void export_level(const Options& o, const MeshImage& m, int index, Context& context) {
    const Level& level = m.levels[static_cast<std::size_t>(index)];
    const std::string extension = lower_extension(o.output);
    BaseMesh mesh = level.mesh;
    if (!o.outline_tolerance) mesh.position = outer_positions(level.mesh, level.map);
    if (extension == ".png") {
        write_image(o.output, id_image(level, m.source.has_mask), {context.overwrite, SampleType::kUint8});
        return;
    }
    if ((extension == ".ply" || extension == ".obj") && split_names(m.source.channel_names).color.empty())
        throw Error(ErrorKind::kUnsupported, cat(o.input, ": the container has no colour to export"));
    std::string text;
    if (extension == ".svg")
        text = o.shading == Shading::kGradient ? draw_svg_gradient(m, index)
                                               : draw_svg(m, index, DrawMode::kFlat);
    else if (extension == ".ply")
        text = ply_from_mesh(mesh);
    else if (extension == ".obj")
        text = obj_from_mesh(mesh, m.source);
    else
        text = sprite_json_from_mesh(
            mesh, m.source,
            o.image.empty() ? fs::path(o.output).filename().replace_extension(".png").string() : o.image,
            context.generator);
    write_text(o.output, text, context.overwrite);
}

Report convert_one(const Options& o, Context& context) {
    check_output(o.output, context.overwrite);
    context.progress(0, "read");
    Container container = read_container(o.input, container_limits(o.limits, context.max_memory));
    MeshImage& m = container.mesh_image;
    check_distinct(container.facts.files, {o.output});
    if (o.texture.wanted.value_or(false) && !o.image.empty())
        check_distinct({o.image}, container_files(o.output));
    const int level = o.level.value_or(0);
    check_level("--level", level, o.input, m);
    context.memory.take_for(o.input, m, bytes_of_pixel(o));
    context.progress(0.5, "write");
    ContainerOptions options;
    const auto outline = [&] { m = outline_mesh_image(m, level, *o.outline_tolerance, o.outline_side); };
    if (is_container(o.output)) {
        options.metadata = container.metadata;
        options.texture = chosen_texture(o, m, std::move(container.texture), context);
        keep_levels(o, m, options.texture);
        options.draco = o.draco.value_or(container.facts.draco);
        options.overwrite = context.overwrite;
        options.keep = container.facts.files;
        options.layers = !o.no_layers && !o.outline_tolerance;
        if (o.outline_tolerance) {
            if (options.texture.picture.empty())
                throw Error(ErrorKind::kBadArgument,
                            cat("--outline-tolerance: ", o.input, " has no texture; --texture makes one"));
            outline();
            options.texture.coords = texture_coords(m);
        }
        write_container(o.output, m, options);
    } else {
        if (o.outline_tolerance) outline();
        export_level(o, m, o.outline_tolerance ? 0 : level, context);
    }
    const Level& first = o.outline_tolerance ? m.levels[0] : m.levels[static_cast<std::size_t>(level)];
    return {{"input", o.input},
            {"output", o.output},
            {"levels", is_container(o.output) ? m.levels.size() : 1},
            {"level", is_container(o.output) ? 0 : level},
            {"vertices", first.mesh.vertex_count()},
            {"faces", first.mesh.faces.size()},
            {"layers", is_container(o.output) && options.layers},
            {"texture", !options.texture.picture.empty()},
            {"bytes", fs::file_size(o.output)}};
}

void print(const Report& report, std::ostream& out) {
    out << printable_line(report["input"].get<std::string>() + " -> " + report["output"].get<std::string>())
        << '\n';
    TextTable table;
    table.add("levels", cat(report["levels"], report["layers"] ? ", with pixel maps" : "",
                            report["texture"] ? ", with a texture" : ""));
    table.add("mesh", cat(report["vertices"], " vertices, ", report["faces"], " faces"));
    table.add("file", format_bytes(report["bytes"].get<std::uint64_t>()));
    table.print(out, 2);
}

std::string line(const Report& report) {
    return cat(report["vertices"], " vertices, ", report["faces"], " faces, ",
               format_bytes(report["bytes"].get<std::uint64_t>()));
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    return tool_main<Options>(
        {.name = "imgmesh-convert",
         .description = "Turn containers into another file variant or compression, or another format.",
         .input_name = "CONTAINER",
         .input_help = "Containers to read (.glb, .gltf)",
         .output_help =
             "Container to write (.glb, .gltf), or a level of it as .svg, .ply, .obj, .json (a sprite's "
             "mesh, as TexturePacker writes it) or .png (24-bit face ids, red the low byte); or a folder, "
             "ended by /, for NAME.glb of each container",
         .type = [] { return "glb"; },
         .sources = {"--image"}},
        {add_options, check_options, convert_one, print, line}, options, argc, argv);
}
