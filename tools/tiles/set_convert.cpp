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

void check_kind(const SetConvertOptions& o) {
    const std::string extension = lower_extension(o.output);
    if (is_container(o.output)) return;
    for (const char* known : {".ply", ".obj", ".svg"})
        if (extension == known) return;
    throw Error(ErrorKind::kUnsupported,
                cat("-o ", o.output, ": a tile set becomes a .glb, .gltf, .ply, .obj or .svg; ", o.input,
                    "/LEVEL/COLUMN_ROW.glb are ordinary containers"));
}

std::string text_of(const SetConvertOptions& o, const MeshImage& whole) {
    const std::string extension = lower_extension(o.output);
    const BaseMesh& mesh = whole.levels[0].mesh;
    if (extension == ".ply") return ply_from_mesh(mesh);
    if (extension == ".obj") return obj_from_mesh(mesh, whole.source);
    return o.gradient ? draw_svg_gradient(whole, 0) : draw_svg(whole, 0, DrawMode::kFlat);
}

}  // namespace

Report convert_set(const SetConvertOptions& o, Context& context) {
    check_kind(o);
    check_output(o.output, context.overwrite);
    context.progress(0, "read");
    const SetInput set = open_set(o.input, o.level, o.limits, context);
    const TileTotals totals = level_totals(set.index, o.level);
    const TileGrid grid = set.grid();
    const bool draco = is_container(o.output) && o.container.draco != DracoMode::kOff;
    context.memory.take(
        cat(o.input, ": level ", o.level, " as one mesh of ", totals.own_vertices, " vertices"),
        kProgramMemory +
            (draco ? kDracoVertexBytes : kVertexBytes) * static_cast<double>(totals.own_vertices) +
            kFaceBytes * static_cast<double>(totals.faces) +
            kTileBytes * (grid.step() + 1) * (grid.step() + 1));
    MeshImage whole;
    whole.source = set.source(o.level);
    static_cast<GridSize&>(whole.source) = level_size(grid, o.level);
    whole.source.has_mask = set.has_gaps();
    whole.generator = context.generator;
    if (split_names(whole.source.channel_names).color.empty() && !is_container(o.output))
        throw Error(ErrorKind::kUnsupported, cat(o.input, ": the tile set has no colour to export"));

    const std::vector<TileName> tiles = grid.tiles(o.level);
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
                     {"level", o.level},
                     {"vertices", level.mesh.vertex_count()},
                     {"faces", level.mesh.faces.size()},
                     {"layers", false},
                     {"texture", false}};
    if (is_container(o.output)) {
        ContainerOptions options = o.container;
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
