// imgmesh-reconstruct: a container or a tile set in, an image out.
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "formats/container/container.h"
#include "formats/files/extension.h"
#include "formats/picture/image_io.h"
#include "formats/tileset/tile_set_files.h"
#include "libcore/image/feature_space.h"
#include "libcore/recon/draw.h"
#include "libcore/recon/draw_channels.h"
#include "libcore/segment/segment.h"
#include "libcore/segment/smooth_image.h"
#include "tools/common/container_input.h"
#include "tools/common/limits.h"
#include "tools/common/memory.h"
#include "tools/common/names.h"
#include "tools/common/options.h"
#include "tools/common/other_tool.h"
#include "tools/common/output.h"
#include "tools/common/read_options.h"
#include "tools/common/source_image.h"
#include "tools/common/text.h"
#include "tools/common/tool_main.h"
#include "tools/tiles/set_draw.h"

using namespace imgmesh;

namespace {

// Drawing and writing take this for each pixel drawn [bytes]; measured as in docs/limits.md.
constexpr double kDrawBytes = 7, kDrawChannelBytes = 9;
// And smoothing this for each pixel.
constexpr double kSmoothBytes = 100;

// Below, a pixel would be the mean of more than a million of the image.
constexpr double kLeastScale = 0.001;

struct Options {
    std::string input;
    std::string output;
    std::optional<DrawMode> mode = DrawMode::kMap;  // nothing: smooth
    double scale = 1;
    std::optional<double> strength;
    std::string image;
    ReadImageOptions read;
    int level = 0;
    std::optional<SampleType> depth;
    std::optional<PixelRect> crop;
    ContainerLimits limits;
};

Choices<std::optional<DrawMode>> mode_choices() {
    Choices<std::optional<DrawMode>> choices;
    for (const auto& [name, mode] : draw_mode_choices()) choices.emplace_back(name, mode);
    choices.emplace_back("smooth", std::nullopt);
    return choices;
}

Choices<SampleType> depth_choices() {
    return {{"8", SampleType::kUint8},
            {"16", SampleType::kUint16},
            {"half", SampleType::kHalf},
            {"float", SampleType::kFloat}};
}

void add_options(CLI::App& app, Options& o) {
    const std::string drawing = "Drawing";
    in_group(
        add_choice(app, "--mode", o.mode, mode_choices(),
                   "What to draw; map is the reconstruction, smooth an image without what is weaker than its "
                   "contours"),
        drawing);
    in_group(add_number(app, "--strength", o.strength, {0, kMostStrength},
                        {"Contours and differences weaker than this vanish in mode smooth, in L*u*v*",
                         cat(kUsualStrength)}),
             drawing);
    CLI::Option* const image =
        in_group(add_file(app, "--image", o.image,
                          "Image itself, to smooth instead of the reconstruction in mode smooth"),
                 drawing);
    o.read.channels.emplace();  // the colour and alpha
    in_group(add_count(app, "--level", o.level, {0},
                       "Level of the pyramid, 0 the finest; of a tile set, level k is of 1/2^k the size"),
             drawing);
    in_group(add_number(
                 app, "--scale", o.scale, {kLeastScale},
                 "Size relative to the source's, for gouraud, wire and flat; the last two are antialiased at "
                 "any size"),
             drawing);
    in_group(add_choice(app, "--depth", o.depth, depth_choices(),
                        {"Type of the samples to write", "that of the source"}),
             drawing);
    in_group(add_value(app, "--crop", "X,Y,W,H",
                       [&o](const std::string& text) { o.crop = parse_crop("--crop", text); },
                       {"Part of a tile set's level to draw, in its pixels", "all"}),
             drawing);
    add_read_options(app, o.read, image, true);
    add_container_limits(app, o.limits);
}

// Throws Error(kBadArgument) for mistakes that can be found before the container is read.
void check_options(const Options& o) {
    if (o.scale != 1 && is_tile_set(o.input))
        throw Error(ErrorKind::kBadArgument,
                    cat("--scale ", o.scale, ": ", o.input,
                        " is a tile set, drawn pixel by pixel; --level K draws it at 1/2^K of its size"));
    const bool svg = lower_extension(o.output) == ".svg";
    const bool plane = o.mode != DrawMode::kGouraud && o.mode != DrawMode::kWire && o.mode != DrawMode::kFlat;
    const std::string mode = name_of(mode_choices(), o.mode);
    if (o.mode && (o.strength || !o.image.empty()))
        throw Error(ErrorKind::kBadArgument,
                    cat(o.strength ? "--strength" : "--image", ": means something with --mode smooth only"));
    if (plane && o.scale != 1)
        throw Error(ErrorKind::kBadArgument, cat("--scale ", o.scale, ": mode ", mode,
                                                 " draws one pixel for one; expected gouraud, wire or flat"));
    if (o.mode == DrawMode::kVisits && o.level != 0)
        throw Error(ErrorKind::kBadArgument, cat("--level ", o.level, ": mode visits is of level 0 alone"));
    if (svg && o.mode != DrawMode::kWire && o.mode != DrawMode::kFlat)
        throw Error(ErrorKind::kBadArgument,
                    cat(o.output, ": mode ", mode, " cannot be drawn as SVG; expected wire or flat"));
    if (svg && (o.depth || o.scale != 1))
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

// Says which channels smoothing leaves out, where the file could hold them.
void tell_left_out(const Options& o, const SourceInfo& source, Context& context) {
    std::string list;
    for (const std::string& name : split_names(source.channel_names).auxiliary)
        if (name != "A") list += (list.empty() ? "" : ", ") + name;
    if (!list.empty() && lower_extension(o.output) == ".exr")
        context.warnings.push_back(
            cat(o.input, ": mode smooth writes colour and alpha alone, without ", list));
}

DrawParams draw_params(const Options& o) {
    return {o.mode.value_or(DrawMode::kMap), o.scale};
}

// Smooths the image itself or, if it is not given, the reconstruction.
Image smooth(const Options& o, const MeshImage& mesh_image, Context& context) {
    const Level& level = mesh_image.levels[static_cast<std::size_t>(o.level)];
    Image image;
    FeatureImage features;
    if (o.image.empty()) {
        image = draw(mesh_image, o.level, draw_params(o));
        features = reconstruct_luv(level);
    } else {
        image = read_source_image(o.image, mesh_image.source, o.input,
                                  image_options(o.read, o.limits, context.max_memory), context.warnings);
        features = luv_image(image, mesh_image.source.gamut == Gamut::kHdr ? Range::kHdr : Range::kClipped);
    }
    return smooth_image(level, features, image, o.strength.value_or(kUsualStrength),
                        [&](double f, std::string_view stage) { context.progress(0.4 + 0.4 * f, stage); });
}

// Returns what reading and drawing take [bytes].
double draw_memory(const Options& o, const MeshImage& mesh_image, bool all_channels) {
    const SourceInfo& source = mesh_image.source;
    const auto channels = static_cast<double>(all_channels ? source.channel_names.size() : 3);
    const double pixels = static_cast<double>(source.width) * source.height;
    if (!o.mode) return container_memory(mesh_image, pixels * kSmoothBytes);
    return container_memory(mesh_image,
                            pixels * o.scale * o.scale * (kDrawBytes + kDrawChannelBytes * channels));
}

// Returns whether all channels are written, not only the colour. Throws Error(kUnsupported) if there is no
// colour to draw.
bool writes_channels(const Options& o, const SourceInfo& source) {
    const SplitNames names = split_names(source.channel_names);
    const std::string extension = lower_extension(o.output);
    const bool values = names.color.empty();
    const bool holds = (extension == ".exr" || (values && (extension == ".tif" || extension == ".tiff"))) &&
                       (o.mode == DrawMode::kMap || o.mode == DrawMode::kGouraud);
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
    if (is_tile_set(o.input))
        return draw_set({o.input, o.output, o.mode, o.level, o.depth, o.crop, o.limits},
                        name_of(mode_choices(), o.mode), context);
    if (o.crop)
        throw Error(ErrorKind::kBadArgument,
                    cat("--crop: ", o.input, " is no tile set; containers are drawn whole"));
    const bool svg = lower_extension(o.output) == ".svg";
    check_output(o.output, context.overwrite);

    context.progress(0, "read");
    const Container container = read_container(o.input, container_limits(o.limits, context.max_memory));
    std::vector<std::string> inputs = container.facts.files;
    if (!o.image.empty()) inputs.push_back(o.image);
    check_distinct(inputs, {o.output});
    const MeshImage& mesh_image = container.mesh_image;
    const SourceInfo& source = mesh_image.source;
    check_level("--level", o.level, o.input, mesh_image);
    if (o.mode == DrawMode::kVisits && mesh_image.visits.empty())
        throw Error(ErrorKind::kUnsupported,
                    cat(o.input, ": there is no visit map; imgmesh-build --visits stores one"));
    const bool all_channels = writes_channels(o, source);
    if (!o.mode) tell_left_out(o, source, context);
    int width = source.width, height = source.height;
    context.progress(0.4, "draw");
    if (svg) {
        write_text(o.output, draw_svg(mesh_image, o.level, *o.mode), context.overwrite);
    } else {
        check_size(source, o.scale);
        context.memory.take(
            cat(o.input, ": a drawing of ", source.width * o.scale, "x", source.height * o.scale, " pixels"),
            draw_memory(o, mesh_image, all_channels));
        const Image image = !o.mode        ? smooth(o, mesh_image, context)
                            : all_channels ? draw_channels(mesh_image, o.level, draw_params(o))
                                           : draw(mesh_image, o.level, draw_params(o));
        context.progress(0.8, "write");
        const bool whole = !o.mode || o.mode == DrawMode::kMap || o.mode == DrawMode::kGouraud;
        write_image(o.output, image,
                    {context.overwrite, o.depth, whole ? container.metadata : ExrMetadata()});
        width = image.width;
        height = image.height;
    }
    const Level& level = mesh_image.levels[static_cast<std::size_t>(o.level)];
    Report report = {{"input", o.input},
                     {"output", o.output},
                     {"mode", name_of(mode_choices(), o.mode)},
                     {"level", o.level},
                     {"scale", o.scale},
                     {"width", width},
                     {"height", height},
                     {"vertices", level.mesh.vertex_count()},
                     {"faces", level.mesh.faces.size()},
                     {"bytes", output_bytes(o.output)}};
    if (!o.mode) report["strength"] = o.strength.value_or(kUsualStrength);
    if (!o.image.empty()) report["image"] = o.image;
    return report;
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
         .description = "Draw the images of containers and tile sets.",
         .input_name = "CONTAINER",
         .input_help = "Containers to read (.glb, .gltf), or folders of tile sets",
         .output_help =
             "Image to write (.png, .exr, .tif, .jpg, ...; .svg of wire and flat), or a folder, ended "
             "by /, for NAME.png of each container",
         .type = [] { return "png"; },
         .sources = {"--image"}},
        {add_options, check_options, draw_one, print, line}, options, argc, argv);
}
