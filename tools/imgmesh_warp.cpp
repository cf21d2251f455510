// imgmesh-warp: applies edits to a container's image. Writes the edited image, maps of the edit, or the
// edited container.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <utility>

#include "formats/container/container.h"
#include "formats/container/edit_file.h"
#include "formats/exr/exr_parts.h"
#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "formats/picture/image_io.h"
#include "libcore/warp/retarget.h"
#include "libcore/warp/solve_edits.h"
#include "libcore/warp/warp_image.h"
#include "libcore/warp/warp_maps.h"
#include "libcore/warp/warp_mesh.h"
#include "tools/common/choices.h"
#include "tools/common/container_input.h"
#include "tools/common/limits.h"
#include "tools/common/memory.h"
#include "tools/common/options.h"
#include "tools/common/output.h"
#include "tools/common/read_options.h"
#include "tools/common/source_image.h"
#include "tools/common/text.h"
#include "tools/common/tool_main.h"
#include "tools/warp_handles.h"

using namespace imgmesh;

namespace {

// What warping takes [bytes a pixel]; measured as in docs/limits.md.
constexpr double kFieldBytes = 24, kImageBytes = 17, kMapBytes = 26;

struct Options {
    std::string input;
    std::string image;
    ReadImageOptions read;
    ContainerLimits limits;
    std::string output;
    std::string displacement;
    std::string edits;
    HandleOptions handles;
    OutputSize size;
    bool retarget = false;  ///< whether `size` comes from --retarget
};

const std::string kSize = "--size", kRetarget = "--retarget";

// WxH
OutputSize size_of(const std::string& name, const std::string& text) {
    const GridSize size = parse_size(name, text, ImageLimits().max_side, ImageLimits().max_pixels);
    return {size.width, size.height};
}

void add_options(CLI::App& app, Options& o) {
    const std::string files = "Files", shape = "Shape";
    CLI::Option* const image =
        in_group(add_file(app, "--image", o.image, "Image that the container was made from"), files);
    in_group(
        add_file(app, "--edits", o.edits, "Edits to make (.json, schemas/imgmesh-warp.edits.schema.json)"),
        files);
    in_group(add_file(app, "--displacement", o.displacement,
                      "Maps of the edit to write (.exr): an STMap, and the displacement of every pixel"),
             files);
    add_handle_options(app, o.handles);
    in_group(add_value(app, kSize, "WxH", [&o](const std::string& text) { o.size = size_of(kSize, text); },
                       {"Size of the image and of the STMap", "that of the image"}),
             shape);
    CLI::Option* const retarget =
        in_group(add_value(
                     app, kRetarget, "WxH",
                     [&o](const std::string& text) {
                         o.size = size_of(kRetarget, text);
                         o.retarget = true;
                     },
                     "As --size, but detail keeps its proportions and the rest of the image gives way"),
                 shape);
    add_read_options(app, o.read, image, true);
    add_container_limits(app, o.limits);
    exclude(app, retarget, {kSize});
}

// Throws Error(kBadArgument) for mistakes that can be found before anything is read.
void check_options(const Options& o) {
    if (o.output.empty() && o.displacement.empty())
        throw Error(ErrorKind::kBadArgument, "nothing to write: expected --output, --displacement or both");
    const bool container = is_container(o.output);
    if (!o.output.empty() && !container && !can_write_image(o.output))
        throw Error(ErrorKind::kBadArgument,
                    cat("-o ", o.output, ": expected the name of an image or container, as in .png or .glb"));
    if (!o.output.empty() && !container && o.image.empty())
        throw Error(ErrorKind::kBadArgument, "--image is missing: the image to draw with");
    if (!o.displacement.empty() && lower_extension(o.displacement) != ".exr")
        throw Error(ErrorKind::kBadArgument,
                    cat("--displacement ", o.displacement, ": expected the name of an .exr"));
    if (o.size.width > 0 && container && (o.retarget || o.displacement.empty()))
        throw Error(ErrorKind::kBadArgument,
                    cat(o.retarget ? kRetarget : kSize, ": a container keeps its image's size"));
}

WarpEdits all_edits(const Options& o) {
    WarpEdits edits;
    if (!o.edits.empty()) edits = read_edits(o.edits);
    if (std::optional<WarpEdit> edit = handle_edit(o.handles)) edits.push_back(std::move(*edit));
    return edits;
}

// Calls edit_solution(). Mistakes of the command line become usage errors.
EditSolution solve(const MeshImage& mesh_image, const WarpEdits& edits, const Options& o) {
    if (handle_edit(o.handles)) check_level("--level", o.handles.edit.level, o.input, mesh_image);
    try {
        return edit_solution(mesh_image, edits);
    } catch (const Error& e) {
        const std::string text = e.what();
        const bool of_file = !o.edits.empty() && text.starts_with(o.edits + ": ");
        if (e.kind() != ErrorKind::kBadFile || of_file) throw;
        throw Error(ErrorKind::kBadArgument, text);
    }
}

// Returns what reading, the field of moves, and drawing and writing take [bytes].
double warp_memory(const Options& o, const MeshImage& mesh_image) {
    const SourceInfo& source = mesh_image.source;
    const double pixels = static_cast<double>(source.width) * source.height;
    const double drawn = o.size.width > 0 ? static_cast<double>(o.size.width) * o.size.height : pixels;
    double bytes = pixels * kFieldBytes;
    if (!o.image.empty()) bytes += (pixels + drawn) * kImageBytes;
    if (!o.displacement.empty()) bytes += drawn * kMapBytes;
    return container_memory(mesh_image, bytes);
}

std::int64_t moved_vertices(const std::vector<VertexMoves>& moves) {
    std::int64_t count = 0;
    for (const VertexMoves& level : moves)
        count += std::count_if(level.begin(), level.end(), [](const Vec2f& m) { return !m.isZero(0); });
    return count;
}

double largest_move(const DisplacementField& field) {
    double largest = 0;
    for (const Vec2f& m : field.move) largest = std::max(largest, std::hypot(double(m.x()), double(m.y())));
    return largest;
}

std::vector<std::string> written_files(const Options& o) {
    std::vector<std::string> files;
    if (is_container(o.output))
        files = container_files(o.output);
    else if (!o.output.empty())
        files = {o.output};
    if (!o.displacement.empty()) files.push_back(o.displacement);
    return files;
}

Report warp_one(const Options& o, Context& context) {
    for (const std::string& path : {o.output, o.displacement})
        if (!path.empty()) check_output(path, context.overwrite);

    context.progress(0, "read");
    const WarpEdits edits = all_edits(o);
    Container container = read_container(o.input, container_limits(o.limits, context.max_memory));
    const MeshImage& mesh_image = container.mesh_image;
    const SourceInfo& source = mesh_image.source;
    std::vector<std::string> read = container.facts.files;
    for (const std::string& path : {o.image, o.edits})
        if (!path.empty()) read.push_back(path);
    check_distinct(read, written_files(o));
    check_separate(written_files(o));
    context.memory.take(cat(o.input, ": warping ", source.width, "x", source.height, " pixels"),
                        warp_memory(o, mesh_image));
    std::optional<Image> image;
    if (!o.image.empty())
        image = read_source_image(o.image, source, o.input,
                                  image_options(o.read, o.limits, context.max_memory), context.warnings);

    for (const std::string& text : far_points(edits, source))
        context.warnings.push_back(cat(o.input, ": ", text));
    context.progress(0.3, "solve");
    const EditSolution solution = solve(mesh_image, edits, o);
    const std::vector<VertexMoves>& moves = solution.moves;
    for (const std::string& text : missed_places(solution))
        context.warnings.push_back(cat(o.input, ": ", text));
    DisplacementField field = edit_field(mesh_image, solution);
    if (o.retarget) add_field(field, retarget_field(mesh_image, o.size));
    Report report = {{"input", o.input},
                     {"edits", edits.size()},
                     {"moved_vertices", moved_vertices(moves)},
                     {"largest_move", largest_move(field)},
                     {"folded_cells", folded_cells(field)}};
    if (std::ranges::any_of(edits, [](const WarpEdit& e) { return e.solver == WarpSolver::kInjective; }))
        report["unreached"] = std::ranges::max(solution.left);
    context.progress(0.5, "draw");
    std::vector<std::string> written = {o.output};
    JointFiles together;
    if (!o.displacement.empty()) {
        const InverseMap map = inverse_map(field, image ? alpha_of(*image) : std::vector<float>(), o.size);
        write_exr_parts(o.displacement,
                        {{"stmap", st_map_image(map, source.width, source.height)},
                         {"displacement", forward_map_image(field)}},
                        context.overwrite);
        report["displacement"] = o.displacement;
    }
    if (is_container(o.output)) {
        MeshImage warped = warp_mesh_image(std::move(container.mesh_image), moves);  // the last use
        warped.generator = context.generator;
        ContainerOptions options;
        options.draco = container.facts.draco;
        if (container.facts.layout == LayerLayout::kCompact)
            context.warnings.push_back(cat(o.input,
                                           ": the edit moves pixels off the grid of compact layers, so ",
                                           o.output, " has an EXR"));
        options.overwrite = context.overwrite;
        options.metadata = container.metadata;
        options.texture = container.texture;  // moves along: vertices keep their texture coordinates
        const WrittenContainer result = write_container(o.output, warped, options);
        written = result.files;
        report["mesh_bytes"] = result.mesh_bytes;
        report["layer_bytes"] = result.layer_bytes;
    } else if (!o.output.empty()) {
        const Image out = warp_image(*image, field, o.size);
        context.progress(0.8, "write");
        write_image(o.output, out, {context.overwrite, {}, container.metadata});
        report["width"] = out.width;
        report["height"] = out.height;
    }
    together.commit();
    if (!o.output.empty()) {
        report["output"] = o.output;
        report["bytes"] = size_of_files(written);
    }
    return report;
}

void print(const Report& report, std::ostream& out) {
    const auto name = [&](const char* member) { return report[member].get<std::string>(); };
    for (const char* member : {"output", "displacement"})
        if (report.contains(member)) out << printable_line(name("input") + " -> " + name(member)) << '\n';
    TextTable table;
    table.add("edits", cat(report["edits"], ", moving ", report["moved_vertices"], " vertices"));
    table.add("largest move", cat(format_number(report["largest_move"]), " pixels"));
    if (report["folded_cells"] != 0)
        table.add("folds", cat(report["folded_cells"], " cells of pixels are turned over"));
    if (report.contains("width")) table.add("size", cat(report["width"], " x ", report["height"]));
    if (report.contains("bytes")) table.add("file", format_bytes(report["bytes"].get<std::uint64_t>()));
    table.print(out, 2);
}

std::string line(const Report& report) {
    return cat(report["moved_vertices"], " vertices moved, at most ", format_number(report["largest_move"]),
               " pixels");
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    return tool_main<Options>(
        {.name = "imgmesh-warp",
         .description = "Edit images by moving vertices of their meshes.",
         .input_name = "CONTAINER",
         .input_help = "Containers to read (.glb, .gltf)",
         .output_help =
             "Edited image to write (.png, .exr, .tif, ...), or edited container (.glb, .gltf), or a "
             "folder, ended by /, for NAME.png, or NAME.glb without --image",
         .output_required = false,
         .type = [&options] { return options.image.empty() ? "glb" : "png"; },
         .sources = {"--image", "--edits"},
         .instead_of_sets = "its LEVEL/COLUMN_ROW.glb are ordinary containers"},
        {add_options,
         check_options,
         warp_one,
         print,
         line,
         {{"--displacement", "exr", &Options::displacement}}},
        options, argc, argv);
}
