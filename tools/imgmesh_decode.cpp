// imgmesh-decode: coded pictures in, images or plain meshes out.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "formats/container/container.h"
#include "formats/export/mesh_export.h"
#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "formats/picture/image_io.h"
#include "libcore/coding/coded_mesh_image.h"
#include "libcore/coding/coded_stream.h"
#include "libcore/coding/image_bitmap.h"
#include "libcore/mesh/outer_edge.h"
#include "libcore/recon/draw.h"
#include "libcore/recon/level_colors.h"
#include "tools/common/container_input.h"
#include "tools/common/help.h"
#include "tools/common/in_file.h"
#include "tools/common/memory.h"
#include "tools/common/numbers.h"
#include "tools/common/options.h"
#include "tools/common/other_tool.h"
#include "tools/common/output.h"
#include "tools/common/text.h"
#include "tools/common/tool_main.h"

using namespace imgmesh;

namespace {

// What reading takes for each point of the grid and each vertex, drawing and writing for each sample and
// pixel drawn, and a mesh for each pixel [bytes]; measured as in docs/limits.md.
constexpr double kPointBytes = 8, kVertexBytes = 400, kSampleBytes = 9, kPixelBytes = 7, kMapBytes = 24;
// Files have fewer; what has more is refused when it has been read.
constexpr double kVerticesOfByte = 0.6;

constexpr double kLeastScale = 0.001;

struct Options {
    std::string input;
    std::string output;
    std::optional<double> scale;
    std::optional<GridSize> size;
    bool info = false;
    std::uint64_t max_bytes = std::uint64_t{1} << 28;
    std::int64_t max_pixels = coding::kMaxPixels;
};

bool is_mesh(const std::string& output) {
    const std::string extension = lower_extension(output);
    return is_container(output) || extension == ".obj" || extension == ".ply" || extension == ".svg";
}

void add_options(CLI::App& app, Options& o) {
    const std::string drawing = "Drawing";
    in_group(
        add_number(app, "--scale", o.scale, {kLeastScale},
                   {"Size of an image relative to the one that was encoded; a mesh keeps its size", "1"}),
        drawing);
    CLI::Option* const size =
        in_group(add_value(
                     app, "--size", "WxH",
                     [&o](const std::string& text) {
                         o.size = parse_size("--size", text, coding::kMaxSide, coding::kMaxPixels);
                     },
                     "Size of the image, whatever its proportions"),
                 drawing);
    exclude(app, size, {"--scale"});
    in_group(add_flag(
                 app, "--info", [&o] { o.info = true; }, "Only tell what the file holds"),
             "Files");
    advanced(app, in_group(add_count(app, "--max-bytes", o.max_bytes, {1}, "Refuse a file of more bytes"),
                           kLimitsGroup));
    advanced(app, in_group(add_count(app, "--max-pixels", o.max_pixels, {1, coding::kMaxPixels},
                                     "Refuse a picture or drawing of more pixels"),
                           kLimitsGroup));
}

void check_options(const Options& o) {
    if (o.info != o.output.empty())
        throw Error(ErrorKind::kBadArgument, o.info ? "--info and --output: --info writes nothing"
                                                    : "-o FILE (--output) is required, or --info");
    if (o.info && (o.scale || o.size))
        throw Error(ErrorKind::kBadArgument,
                    cat(o.scale ? "--scale" : "--size", ": nothing is drawn with --info"));
    if (o.info) return;
    if (!is_mesh(o.output) && !can_write_image(o.output))
        throw Error(ErrorKind::kBadArgument, cat("-o ", o.output,
                                                 ": expected the name of an image, as in .png, or of a mesh: "
                                                 ".glb, .gltf, .obj, .ply or .svg",
                                                 other_tool("imgmesh-decode", o.output)));
    if (is_mesh(o.output) && (o.scale || o.size))
        throw Error(ErrorKind::kBadArgument,
                    cat(o.scale ? "--scale" : "--size", ": a mesh (-o ", o.output, ") has no pixels"));
}

GridSize drawn_size(const Options& o, const CodedGrid& grid) {
    if (o.size) return *o.size;
    const double scale = o.scale.value_or(1), most = coding::kMaxSide;
    const auto side = [&](int pixels) {
        return static_cast<int>(std::clamp(std::round(pixels * scale), 1.0, most + 1));
    };
    return {side(grid.width), side(grid.height)};
}

void check_size(const GridSize& size, const Options& o) {
    if (std::max(size.width, size.height) <= coding::kMaxSide &&
        std::int64_t{size.width} * size.height <= o.max_pixels)
        return;
    throw Error(ErrorKind::kBadArgument,
                cat(o.size ? "--size" : "--scale", ": ", o.input, " would have more than ", coding::kMaxSide,
                    " pixels a side or ", o.max_pixels, " in all"));
}

// What the file says, before the rest is read.
coding::StreamHead read_head(const Options& o, std::span<const std::uint8_t> bytes) {
    const coding::StreamHead head = in_file(o.input, [&] { return coding::read_head(bytes); });
    if (std::int64_t{head.grid.width} * head.grid.height > o.max_pixels)
        throw Error(ErrorKind::kBadFile, cat(o.input, ": is ", head.grid.width, " x ", head.grid.height,
                                             " pixels, more than the limit of ", o.max_pixels));
    return head;
}

coding::StreamContent read_content(const Options& o, Context& context, std::uint64_t& size) {
    const std::vector<std::uint8_t> bytes = read_file(o.input, o.max_bytes);
    size = bytes.size();
    const coding::StreamHead head = read_head(o, bytes);
    const double points = static_cast<double>(head.grid.columns()) * head.grid.rows();
    double work = kProgramMemory + points * kPointBytes +
                  kVertexBytes * std::min(points, kVerticesOfByte * static_cast<double>(size));
    const GridSize drawn = drawn_size(o, head.grid);
    if (is_mesh(o.output)) {
        work += kMapBytes * head.grid.width * head.grid.height;
    } else if (!o.info) {
        check_size(drawn, o);
        work += static_cast<double>(drawn.pixel_count()) * (kPixelBytes + kSampleBytes * head.channels);
    }
    context.memory.take(cat(o.input, ": decoding"), work);
    const double left = static_cast<double>(context.max_memory) - kProgramMemory - points * kPointBytes;
    return in_file(o.input, [&] {
        return coding::read_stream(bytes, static_cast<std::size_t>(std::max(left / kVertexBytes, 4.0)));
    });
}

void write_mesh(const Options& o, const coding::StreamContent& content, Context& context) {
    const bool overwrite = context.overwrite;
    MeshImage m = coding::mesh_image_from_coded(content);
    const std::string extension = lower_extension(o.output);
    if (alpha_feature(m.source) >= 0 && (extension == ".ply" || extension == ".obj"))
        context.warnings.push_back(cat(o.input, ": its alpha is lost, ", extension, " has none"));
    if (extension == ".svg") {
        write_text(o.output, draw_svg_gradient(m, 0), overwrite);
        return;
    }
    cover_whole_pixels(m);
    if (is_container(o.output))
        write_container(o.output, m,
                        {.draco = DracoMode::kOff, .overwrite = overwrite, .layers = LayerLayout::kOff});
    else if (extension == ".ply")
        write_text(o.output, ply_from_mesh(m.levels[0].mesh), overwrite);
    else
        write_text(o.output, obj_from_mesh(m.levels[0].mesh, m.source), overwrite);
}

Report decode_one(const Options& o, Context& context) {
    if (!o.info) check_output(o.output, context.overwrite);
    context.progress(0, "read");
    std::uint64_t size = 0;
    const coding::StreamContent content = read_content(o, context, size);
    const CodedGrid& grid = content.grid;
    Report report = {{"input", o.input},
                     {"width", grid.width},
                     {"height", grid.height},
                     {"channels", make_image(1, 1, content.channels).channel_names},
                     {"vertices", content.point.size()},
                     {"faces", content.faces.size()},
                     {"grid_step", grid.step / 4.0},
                     {"coded_bytes", size}};
    if (o.info) return report;
    report["output"] = o.output;
    context.progress(0.4, "draw");
    if (is_mesh(o.output)) {
        write_mesh(o, content, context);
    } else {
        const GridSize drawn = drawn_size(o, grid);
        Bitmap picture{drawn.width, drawn.height, content.channels, {}};
        picture.data =
            coding::draw_coded(content.shape(), content.color, content.channels, drawn.width, drawn.height);
        context.progress(0.6, "write");
        write_image(o.output, image_from_bitmap(picture), {context.overwrite, std::nullopt});
        report["drawn_width"] = drawn.width;
        report["drawn_height"] = drawn.height;
    }
    report["bytes"] = output_bytes(o.output);
    return report;
}

std::string bytes_text(const Report& report, const char* name) {
    return format_bytes(report[name].get<std::uint64_t>());
}

void print(const Report& report, std::ostream& out) {
    std::string names = report["input"].get<std::string>();
    if (report.contains("output")) names += " -> " + report["output"].get<std::string>();
    out << printable_line(names) << '\n';
    std::string channels;
    for (const Report& name : report["channels"])
        channels += (channels.empty() ? "" : " ") + name.get<std::string>();
    TextTable table;
    table.add("size", cat(report["width"], " x ", report["height"], " pixels, ", channels));
    table.add("mesh", cat(report["vertices"], " vertices, ", report["faces"], " faces, on a grid of ",
                          format_number(report["grid_step"].get<double>()), " pixels"));
    table.add("coded", bytes_text(report, "coded_bytes"));
    if (report.contains("drawn_width"))
        table.add("drawn", cat(report["drawn_width"], " x ", report["drawn_height"], " pixels"));
    if (report.contains("bytes")) table.add("file", bytes_text(report, "bytes"));
    table.print(out, 2);
}

std::string line(const Report& report) {
    return cat(report["width"], " x ", report["height"], " pixels, ", report["vertices"], " vertices, ",
               bytes_text(report, report.contains("bytes") ? "bytes" : "coded_bytes"));
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    return tool_main<Options>(
        {.name = "imgmesh-decode",
         .description = "Draw coded pictures, at any size, or turn them into plain meshes.",
         .input_name = "CODED",
         .input_help = "Coded pictures to read (.imgm)",
         .output_help =
             "Image to write (.png, .jpg, .webp, .tif, ...), or its mesh (.glb, .gltf, .obj, .ply, .svg), or "
             "a folder, ended by /, for NAME.png of each file",
         .output_required = false,
         .type = [] { return "png"; },
         .instead_of_sets = "imgmesh-reconstruct draws it"},
        {add_options, check_options, decode_one, print, line}, options, argc, argv);
}
