#include "tools/tiles/set_convert.h"

#include <nlohmann/json.hpp>

#include "formats/export/mesh_export.h"
#include "formats/files/extension.h"
#include "formats/tileset/tile_set_files.h"
#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"
#include "libcore/recon/draw.h"
#include "libcore/tiles/tile_joiner.h"
#include "tools/common/container_input.h"
#include "tools/common/output.h"
#include "tools/tiles/set_input.h"

namespace imgmesh {
namespace {

// What a vertex and a face take as a mesh, and while they are written [bytes]; measured as in docs/limits.md.
constexpr double kVertexBytes = 120, kFaceBytes = 90, kDracoVertexBytes = 250;
// And a pixel of the tile that is read.
constexpr double kTileBytes = 40;

void check_kind(const ConvertOptions& o) {
    const std::string extension = lower_extension(o.output);
    if (is_container(o.output)) return;
    for (const char* known : {".ply", ".obj", ".svg"})
        if (extension == known) return;
    throw Error(ErrorKind::kUnsupported,
                cat("-o ", o.output, ": a tile set becomes a .glb, .gltf, .ply, .obj or .svg; ",
                    single_tiles(o.input)));
}

std::string text_of(const ConvertOptions& o, const MeshImage& whole) {
    const std::string extension = lower_extension(o.output);
    const BaseMesh& mesh = whole.levels[0].mesh;
    if (extension == ".ply") return ply_from_mesh(mesh);
    if (extension == ".obj") return obj_from_mesh(mesh, whole.source);
    return o.shading == Shading::kGradient ? draw_svg_gradient(whole, 0)
                                           : draw_svg(whole, 0, DrawMode::kFlat);
}

}  // namespace

void check_set_options(const ConvertOptions& o) {
    const auto refuse = [&](bool given, const char* option) {
        if (given)
            throw Error(ErrorKind::kBadArgument,
                        cat(option, ": ", o.input, " is a tile set, which becomes one mesh without a map; ",
                            single_tiles(o.input)));
    };
    refuse(!o.levels.empty(), "--levels");
    refuse(o.compression.layers.has_value(), "--layers");
    refuse(o.precision == MeshPrecision::kCompact, "--mesh-precision");
    refuse(o.texture.wanted.value_or(false), "--texture");
    refuse(o.as.has_value(), "--as");
    refuse(o.outline_tolerance.has_value(), "--outline-tolerance");
    refuse(!o.image.empty(), "--image");
    check_kind(o);
    const auto only_for = [&](bool given, const char* option, bool fits, const char* what) {
        if (given && !fits)
            throw Error(ErrorKind::kBadArgument, cat(option, ": -o ", o.output, " is no ", what));
    };
    const bool container = is_container(o.output);
    only_for(o.compression.draco.has_value(), "--draco", container, "container");
    only_for(o.compression.method.has_value(), "--compression", container, "container");
    only_for(o.shading.has_value(), "--shading", lower_extension(o.output) == ".svg", "SVG");
}

Report convert_set(const ConvertOptions& o, Context& context) {
    const int index = o.level.value_or(0);
    ContainerOptions options;
    compress(options, o.compression, DracoMode::kOff);
    check_output(o.output, context.overwrite);
    context.progress(0, "read");
    const SetInput set = open_set(o.input, index, o.limits, context);
    const TileTotals totals = level_totals(set.index, index);
    const TileGrid grid = set.grid();
    const bool draco = is_container(o.output) && options.draco != DracoMode::kOff;
    context.memory.take(
        cat(o.input, ": level ", index, " as one mesh of ", totals.own_vertices, " vertices"),
        kProgramMemory +
            (draco ? kDracoVertexBytes : kVertexBytes) * static_cast<double>(totals.own_vertices) +
            kFaceBytes * static_cast<double>(totals.faces) +
            kTileBytes * (grid.step() + 1) * (grid.step() + 1));
    MeshImage whole;
    whole.source = set.source(index);
    static_cast<GridSize&>(whole.source) = level_size(grid, index);
    // A drawing would look at the pixel map for the outline of a mask, and there is none.
    whole.source.has_mask = is_container(o.output) && set.has_gaps();
    whole.generator = context.generator;
    if (split_names(whole.source.channel_names).color.empty() && !is_container(o.output))
        throw Error(ErrorKind::kUnsupported, cat(o.input, ": the tile set has no colour to export"));

    const std::vector<TileName> tiles = grid.tiles(index);
    // In units of the level every tile but the last ones spans the same.
    const auto step = static_cast<float>(grid.step());
    TileJoiner joiner;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        context.progress(0.8 * static_cast<double>(i) / static_cast<double>(tiles.size()), "read");
        const MeshImage image = set.read(tiles[i]);
        if (image.levels.empty()) continue;
        const Vec2f place(static_cast<float>(tiles[i].column), static_cast<float>(tiles[i].row));
        joiner.add(image.levels[0].mesh, step * place, Vec2f(step, step));
    }
    Level& level = whole.levels.emplace_back();
    level.mesh = joiner.take();
    context.progress(0.8, "write");
    std::vector<std::string> files = {o.output};
    Report report = {{"input", o.input},
                     {"output", o.output},
                     {"levels", 1},
                     {"level", index},
                     {"vertices", level.mesh.vertex_count()},
                     {"faces", level.mesh.faces.size()},
                     {"layers", false},
                     {"texture", false}};
    if (is_container(o.output)) {
        options.layers = LayerLayout::kOff;
        options.overwrite = context.overwrite;
        const WrittenContainer written = write_container(o.output, whole, options);
        files = written.files;
        report["mesh_bytes"] = written.mesh_bytes;
        report["layer_bytes"] = written.layer_bytes;
    } else {
        write_text(o.output, text_of(o, whole), context.overwrite);
    }
    report["bytes"] = size_of_files(files);
    if (files.size() > 1) report["outputs"] = files;
    return report;
}

}  // namespace imgmesh
