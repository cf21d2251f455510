// imgmesh-reconstruct: a container in, an image out.
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "formats/container/container.h"
#include "formats/files/extension.h"
#include "formats/picture/image_io.h"
#include "libcore/image/feature_space.h"
#include "libcore/recon/draw.h"
#include "libcore/recon/draw_channels.h"
#include "tools/common/container_input.h"
#include "tools/common/limits.h"
#include "tools/common/memory.h"
#include "tools/common/names.h"
#include "tools/common/options.h"
#include "tools/common/other_tool.h"
#include "tools/common/output.h"
#include "tools/common/text.h"
#include "tools/common/tool_main.h"

using namespace imgmesh;

namespace {

// Drawing and writing take this for each pixel drawn [bytes]; measured as in docs/limits.md.
constexpr double kDrawBytes = 7, kDrawChannelBytes = 9;

// Below, a pixel would be the mean of more than a million of the image.
constexpr double kLeastScale = 0.001;

struct Options {
    std::string input;
    std::string output;
    DrawParams draw;
    int level = 0;
    std::optional<SampleType> depth;
    ContainerLimits limits;
};

Choices<SampleType> depth_choices() {
    return {{"8", SampleType::kUint8},
            {"16", SampleType::kUint16},
            {"half", SampleType::kHalf},
            {"float", SampleType::kFloat}};
}

void add_options(CLI::App& app, Options& o) {
    const std::string drawing = "Drawing";
    in_group(add_choice(app, "--mode", o.draw.mode, draw_mode_choices(),
                        "What to draw; map is the reconstruction"),
             drawing);
    in_group(add_count(app, "--level", o.level, {0}, "Level of the pyramid, 0 the finest"), drawing);
    in_group(add_number(
                 app, "--scale", o.draw.scale, {kLeastScale},
                 "Size relative to the source's, for gouraud, wire and flat; the last two are antialiased at "
                 "any size"),
             drawing);
    in_group(add_choice(app, "--depth", o.depth, depth_choices(),
                        {"Type of the samples to write", "that of the source"}),
             drawing);
    add_container_limits(app, o.limits);
}

// Throws Error(kBadArgument) for mistakes that can be found before the container is read.
void check_options(const Options& o) {
    const bool svg = lower_extension(o.output) == ".svg";
    const bool plane = o.draw.mode == DrawMode::kMap || o.draw.mode == DrawMode::kPatches ||
                       o.draw.mode == DrawMode::kVisits;
    const std::string mode = name_of(draw_mode_choices(), o.draw.mode);
    if (plane && o.draw.scale != 1)
        throw Error(ErrorKind::kBadArgument, cat("--scale ", o.draw.scale, ": mode ", mode,
                                                 " draws one pixel for one; expected gouraud, wire or flat"));
    if (o.draw.mode == DrawMode::kVisits && o.level != 0)
        throw Error(ErrorKind::kBadArgument, cat("--level ", o.level, ": mode visits is of level 0 alone"));
    if (svg && o.draw.mode != DrawMode::kWire && o.draw.mode != DrawMode::kFlat)
        throw Error(ErrorKind::kBadArgument,
                    cat(o.output, ": mode ", mode, " cannot be drawn as SVG; expected wire or flat"));
    if (svg && (o.depth || o.draw.scale != 1))
        throw Error(ErrorKind::kBadArgument, cat(o.output, ": an SVG has neither --depth nor --scale"));
    if (!svg && !can_write_image(o.output))
        throw Error(ErrorKind::kBadArgument,
                    cat("-o ", o.output, ": expected the name of an image, as in .png",
                        other_tool("imgmesh-reconstruct", o.output)));
}

// Throws Error(kBadArgument) if a scaled image would be larger than any that can be read.
void check_size(const SourceInfo& source, double scale) {
    const ImageLimits limits;
    const double width = source.width * scale, height = source.height * scale;
    if (std::max(width, height) > limits.max_side || width * height > static_cast<double>(limits.max_pixels))
        throw Error(ErrorKind::kBadArgument,
                    cat("--scale ", scale, ": the image would have ", width, " x ", height,
                        " pixels, more than ", limits.max_side, " a side or ", limits.max_pixels, " in all"));
}

// Returns what reading and drawing take [bytes].
double draw_memory(const Options& o, const MeshImage& mesh_image, bool all_channels) {
    const SourceInfo& source = mesh_image.source;
    const auto channels = static_cast<double>(all_channels ? source.channel_names.size() : 3);
    const double pixels = static_cast<double>(source.width) * source.height;
    return container_memory(
        mesh_image, pixels * o.draw.scale * o.draw.scale * (kDrawBytes + kDrawChannelBytes * channels));
}

// Returns whether all channels are written, not only the colour. Throws Error(kUnsupported) if there is no
// colour to draw.
bool writes_channels(const Options& o, const SourceInfo& source) {
    const SplitNames names = split_names(source.channel_names);
    const std::string extension = lower_extension(o.output);
    const bool values = names.color.empty();
    const bool holds = (extension == ".exr" || (values && (extension == ".tif" || extension == ".tiff"))) &&
                       (o.draw.mode == DrawMode::kMap || o.draw.mode == DrawMode::kGouraud);
    if (values && !holds) {
        std::string list;
        for (const std::string& name : names.auxiliary) list += (list.empty() ? "" : ", ") + name;
        throw Error(ErrorKind::kUnsupported,
                    cat(o.input, ": has no colour, its channels are ", list,
                        "; they can be written as .exr or .tif in mode map or gouraud"));
    }
    return holds && !names.auxiliary.empty();
}

Report draw_one(const Options& o, Context& context) {
    const bool svg = lower_extension(o.output) == ".svg";
    check_output(o.output, context.overwrite);

    context.progress(0, "read");
    const Container container = read_container(o.input, container_limits(o.limits, context.max_memory));
    check_distinct(container.facts.files, {o.output});
    const MeshImage& mesh_image = container.mesh_image;
    const SourceInfo& source = mesh_image.source;
    check_level("--level", o.level, o.input, mesh_image);
    if (o.draw.mode == DrawMode::kVisits && mesh_image.visits.empty())
        throw Error(ErrorKind::kUnsupported,
                    cat(o.input, ": there is no visit map; imgmesh-build --visits stores one"));
    const bool all_channels = writes_channels(o, source);
    int width = source.width, height = source.height;
    context.progress(0.4, "draw");
    if (svg) {
        write_text(o.output, draw_svg(mesh_image, o.level, o.draw.mode), context.overwrite);
    } else {
        check_size(source, o.draw.scale);
        context.memory.take(cat(o.input, ": a drawing of ", source.width * o.draw.scale, "x",
                                source.height * o.draw.scale, " pixels"),
                            draw_memory(o, mesh_image, all_channels));
        const Image image =
            all_channels ? draw_channels(mesh_image, o.level, o.draw) : draw(mesh_image, o.level, o.draw);
        context.progress(0.8, "write");
        const bool whole = o.draw.mode == DrawMode::kMap || o.draw.mode == DrawMode::kGouraud;
        write_image(o.output, image,
                    {context.overwrite, o.depth, whole ? container.metadata : ExrMetadata()});
        width = image.width;
        height = image.height;
    }
    const Level& level = mesh_image.levels[static_cast<std::size_t>(o.level)];
    return {{"input", o.input},
            {"output", o.output},
            {"mode", name_of(draw_mode_choices(), o.draw.mode)},
            {"level", o.level},
            {"scale", o.draw.scale},
            {"width", width},
            {"height", height},
            {"vertices", level.mesh.vertex_count()},
            {"faces", level.mesh.faces.size()},
            {"bytes", output_bytes(o.output)}};
}

void print(const Report& report, std::ostream& out) {
    out << printable_line(report["input"].get<std::string>() + " -> " + report["output"].get<std::string>())
        << '\n';
    TextTable table;
    table.add("drawing", cat(report["mode"].get<std::string>(), " of level ", report["level"]));
    table.add("size", cat(report["width"], " x ", report["height"]));
    table.add("mesh", cat(report["vertices"], " vertices, ", report["faces"], " faces"));
    table.add("file", format_bytes(report["bytes"].get<std::uint64_t>()));
    table.print(out, 2);
}

std::string line(const Report& report) {
    return cat(report["width"], " x ", report["height"], ", ",
               format_bytes(report["bytes"].get<std::uint64_t>()));
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    return tool_main<Options>(
        {.name = "imgmesh-reconstruct",
         .description = "Draw the images of containers.",
         .input_name = "CONTAINER",
         .input_help = "Containers to read (.glb, .gltf)",
         .output_help =
             "Image to write (.png, .exr, .tif, .jpg, ...; .svg of wire and flat), or a folder, ended "
             "by /, for NAME.png of each container",
         .type = [] { return "png"; }},
        {add_options, check_options, draw_one, print, line}, options, argc, argv);
}
