#include "tools/convert_options.h"

#include "formats/files/extension.h"
#include "libcore/base/error.h"
#include "tools/common/container_input.h"
#include "tools/common/help.h"
#include "tools/common/limits.h"
#include "tools/common/names.h"
#include "tools/common/numbers.h"
#include "tools/common/options.h"
#include "tools/common/other_tool.h"
#include "tools/common/read_options.h"

namespace imgmesh {
namespace {

// More than a container can have; its own number is checked when it has been read.
constexpr CountRange kLevelRange = {0, 1000};

// Beyond, a sprite's outline is no longer its own.
constexpr double kMostTolerance = 64;

}  // namespace

void add_convert_options(CLI::App& app, ConvertOptions& o) {
    const std::string container = "Container", level = "Level";
    add_compression_options(app, o.compression, "as in the input; with --no-map none",
                            "as in the input; exr with a new texture");
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
                 app, "--no-map", [&o] { o.no_map = true; },
                 "Write the meshes alone: a plain glTF asset for engines, that imgmesh cannot read"),
             container);
    advanced(app, in_group(add_choice(app, "--mesh-precision", o.precision,
                                      Choices<MeshPrecision>{{"exact", MeshPrecision::kExact},
                                                             {"compact", MeshPrecision::kCompact}},
                                      "Precision of the meshes: as in the input, or colours of 128 levels "
                                      "and with --no-map coarser positions, for fewer bytes"),
                           container));
    // Its name until it had one in imgmesh-build, too.
    in_group(add_flag(
                 app, "--no-layers", [&o] { o.no_map = true; }, "The same as --no-map"),
             "");
    add_texture_options(app, o.texture,
                        {"Put an image on the meshes, for engines and viewers: that of --image, or else the "
                         "reconstruction",
                         "the input's texture, if it has one"},
                        true);
    in_group(add_count(app, "--level", o.level, kLevelRange, {"Level to export, 0 the finest", "0"}), level);
    in_group(add_choice(app, "--as", o.as, export_kinds(),
                        {"What a .json is (texturepacker, which PixiJS reads, spine or outline), a .tscn "
                         "(polygon2d or meshinstance2d), or an .svg (outline)",
                         "texturepacker, polygon2d, an .svg's triangles"}),
             level);
    in_group(add_choice(app, "--shading", o.shading,
                        Choices<Shading>{{"flat", Shading::kFlat}, {"gradient", Shading::kGradient}},
                        {"Shading of an .svg's triangles", "flat"}),
             level);
    CLI::Option* const tolerance = in_group(
        add_number(
            app, "--outline-tolerance", o.outline_tolerance, {0, kMostTolerance},
            {"Make the mesh of a sprite (.json, .tscn, .obj, or a container with a texture) from its outline "
             "alone, or an outline itself, which may lie this many pixels from the image's",
             "none: the base mesh, or the outline of the pixels"}),
        level);
    CLI::Option* const side =
        add_choice(app, "--outline-side", o.outline_side,
                   Choices<OutlineSide>{{"out", OutlineSide::kOut}, {"both", OutlineSide::kBoth}},
                   "Where that outline may lie: outside alone, where it cuts no pixel, or on both sides");
    in_group(needs(side, tolerance), level);
    CLI::Option* const image = in_group(
        add_value(app, "--image", "NAME", [&o](const std::string& text) { o.image = text; },
                  {"Image that --texture puts on the meshes, or that a sprite's .json or .tscn names",
                   "the output's name in .png"}),
        "Files");
    add_read_options(app, o.read, image, true);
    add_container_limits(app, o.limits);
}

LevelOptions level_options(const ConvertOptions& o) {
    return {o.input, o.output, o.as, o.shading, o.outline_tolerance, o.outline_side, o.image};
}

void check_convert_options(const ConvertOptions& o) {
    const std::string extension = lower_extension(o.output);
    const auto only_for = [&](bool given, const char* option, bool fits, const char* what) {
        if (given && !fits)
            throw Error(ErrorKind::kBadArgument, cat(option, ": -o ", o.output, " is no ", what));
    };
    const bool container = is_container(o.output), obj = extension == ".obj";
    if (!container && !is_level_file(o.output))
        throw Error(ErrorKind::kBadArgument,
                    cat("-o ", o.output,
                        ": expected a name in .glb, .gltf, .svg, .ply, .obj, .json, .tscn, .png or .npz",
                        other_tool("imgmesh-convert", o.output)));
    const std::optional<ExportKind> kind = export_kind(level_options(o));
    const bool outline = kind == ExportKind::kOutline, sprite = kind && !outline;
    only_for(o.compression.draco.has_value(), "--draco", container, "container");
    only_for(!o.levels.empty(), "--levels", container, "container");
    only_for(o.compression.method.has_value(), "--compression", container, "container");
    only_for(o.no_map, "--no-map", container, "container");
    only_for(o.precision == MeshPrecision::kCompact, "--mesh-precision", container, "container");
    only_for(o.compression.layers.has_value(), "--layers", container, "container");
    check_compression(o.compression, !o.no_map && !o.outline_tolerance);
    if (o.compression.layers == LayerLayout::kCompact && o.texture.wanted.value_or(false))
        throw Error(ErrorKind::kBadArgument,
                    "--layers compact and --texture: the meshes of a texture are stretched, so that pixels "
                    "leave the grid that compact layers need");
    only_for(o.texture.wanted.has_value(), "--texture", container || obj, "container or .obj");
    if (container && o.level)
        throw Error(ErrorKind::kBadArgument, cat("--level: ", o.output, " keeps all levels; see --levels"));
    only_for(o.shading.has_value(), "--shading", extension == ".svg" && !outline, "SVG of triangles");
    if (container && !o.image.empty() && !o.texture.wanted.value_or(false))
        throw Error(ErrorKind::kBadArgument, "--image: of use to a container only with --texture");
    only_for(!o.image.empty(), "--image", container || obj || sprite, "container, .obj or sprite");
    if (obj && !o.image.empty() && !o.texture.wanted.value_or(true))
        throw Error(ErrorKind::kBadArgument, "--image and --no-texture: the image would be of no use");
    only_for(o.outline_tolerance.has_value(), "--outline-tolerance", container || obj || sprite || outline,
             "container, .obj, sprite or outline");
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

}  // namespace imgmesh
