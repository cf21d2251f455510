// imgmesh-segment: a container in, labelled regions out.
#include <nlohmann/json.hpp>
#include <ostream>

#include "formats/container/container.h"
#include "formats/export/contour_files.h"
#include "formats/export/label_files.h"
#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "formats/gltf/region_gltf.h"
#include "formats/picture/image_io.h"
#include "libcore/image/color.h"
#include "libcore/image/feature_space.h"
#include "libcore/segment/contour_map.h"
#include "libcore/segment/draw_regions.h"
#include "libcore/segment/region_faces.h"
#include "libcore/segment/segment.h"
#include "tools/common/choices.h"
#include "tools/common/container_input.h"
#include "tools/common/help.h"
#include "tools/common/limits.h"
#include "tools/common/memory.h"
#include "tools/common/names.h"
#include "tools/common/options.h"
#include "tools/common/output.h"
#include "tools/common/read_options.h"
#include "tools/common/source_image.h"
#include "tools/common/targets.h"
#include "tools/common/text.h"
#include "tools/common/tool_main.h"
#include "tools/segment_report.h"

using namespace imgmesh;

namespace {

// Reading, segmenting and writing take this, beside the container itself [bytes a pixel]; measured as in
// docs/limits.md.
constexpr double kSegmentBytes = 66;

// Far beyond, distances of merges would not be finite.
constexpr double kMostCompactness = 1e6;

struct Options {
    std::string input, output;
    SegmentParams params;
    std::optional<double> threshold, compactness;
    std::optional<DistanceRule> distance;
    int level = 0;
    std::string image, outlines, flat, ucm, report, mesh;
    ReadImageOptions read;
    ContainerLimits limits;
    bool strict = false;
};

void add_options(CLI::App& app, Options& o) {
    const SegmentParams usual;
    const std::string regions = "Regions", files = "Files";
    in_group(add_number(app, "--threshold", o.threshold, {0, kNoLimit, true},
                        {"Merge regions that are closer than this, in L*u*v*", cat(usual.threshold)}),
             regions);
    in_group(add_count(app, "--segments", o.params.segments, {1}, "Merge until this many regions are left"),
             regions);
    in_group(add_count(app, "--superpixels", o.params.superpixels, {1},
                       "Make this many regions of similar size that follow edges"),
             regions);
    in_group(add_count(app, "--min-size", o.params.min_size, {1}, "Least number of pixels of a region"),
             regions);
    in_group(add_count(app, "--level", o.level, {0}, "Level of the pyramid, 0 the finest"), regions);
    CLI::Option* const compactness =
        add_number(app, "--compactness", o.compactness, {0, kMostCompactness},
                   {"Compactness of superpixels; higher is rounder", cat(usual.compactness)});
    advanced(app, in_group(compactness, regions));
    CLI::Option* const distance =
        add_choice(app, "--distance", o.distance, distance_choices(),
                   {"Distance of regions, by their contours or by mean colours as in the paper",
                    name_of(distance_choices(), usual.distance)});
    advanced(app, in_group(distance, regions));
    CLI::Option* const image =
        in_group(add_file(app, "--image", o.image,
                          "Image itself, to measure and draw on instead of the reconstruction"),
                 files);
    add_read_options(app, o.read, image, true);
    add_container_limits(app, o.limits);
    add_strict_option(app, o.strict);
    o.read.channels.emplace();  // the colour and alpha
    in_group(
        add_file(app, "--outlines", o.outlines, "Image to write with the regions' borders drawn over it"),
        files);
    in_group(add_file(app, "--flat", o.flat, "Image to write with each region in its mean colour"), files);
    in_group(add_file(app, "--report", o.report,
                      "List to write of each region's colour, pixels, box and neighbours (.json)"),
             files);
    in_group(add_file(app, "--mesh", o.mesh, "Base mesh to write with one primitive for each region (.glb)"),
             files);
    advanced(app, in_group(add_file(app, "--ucm", o.ucm,
                                    "Ultrametric contour map to write (.exr, .npy, or .mat with ucm2)"),
                           files));
}

std::vector<std::string> outputs_of(const Options& o) {
    std::vector<std::string> outputs = {o.output};
    for (const std::string* path : {&o.outlines, &o.flat, &o.ucm, &o.report, &o.mesh})
        if (!path->empty()) outputs.push_back(*path);
    return outputs;
}

void expect_extension(const std::string& option, const std::string& path, const std::string& extension) {
    if (!path.empty() && lower_extension(path) != extension)
        throw Error(ErrorKind::kBadArgument,
                    cat(option, " ", path, ": expected a name that ends with ", extension));
}

// Throws Error(kBadArgument) for mistakes that can be found before the container is read.
void check_options(const Options& o) {
    if (o.threshold && o.params.segments)
        throw Error(ErrorKind::kBadArgument, "--threshold and --segments: expected one of them");
    if (o.params.superpixels && (o.threshold || o.params.segments || o.distance))
        throw Error(ErrorKind::kBadArgument, cat("--superpixels and ",
                                                 o.threshold         ? "--threshold"
                                                 : o.params.segments ? "--segments"
                                                                     : "--distance",
                                                 ": expected one of them"));
    if (o.compactness && !o.params.superpixels)
        throw Error(ErrorKind::kBadArgument, "--compactness: means something with --superpixels only");
    if (!can_write_labels(o.output))
        throw Error(ErrorKind::kBadArgument,
                    cat("-o ", o.output, ": expected a name that ends with .exr, .png, .tif, .npy or .mat"));
    if (!o.ucm.empty() && !can_write_contours(o.ucm))
        throw Error(ErrorKind::kBadArgument,
                    cat("--ucm ", o.ucm, ": expected a name that ends with .exr, .npy or .mat"));
    expect_extension("--report", o.report, ".json");
    expect_extension("--mesh", o.mesh, ".glb");
    for (const auto& [option, path] : {std::pair("--outlines", &o.outlines), std::pair("--flat", &o.flat)})
        if (!path->empty() && !can_write_image(*path))
            throw Error(ErrorKind::kBadArgument,
                        cat(option, " ", *path, ": expected the name of an image, as in .png"));
    check_separate(outputs_of(o));
}

FeatureImage picture_of(const Options& o, const MeshImage& mesh_image, const Level& level, Context& context) {
    if (o.image.empty()) return reconstruct_luv(level);
    return luv_image(read_source_image(o.image, mesh_image.source, o.input,
                                       image_options(o.read, o.limits, context.max_memory), context.warnings),
                     Range::kClipped);
}

Report segment_one(const Options& o, Context& context) {
    for (const std::string& output : outputs_of(o)) check_output(output, context.overwrite);

    context.progress(0, "read");
    const Container container = read_container(o.input, container_limits(o.limits, context.max_memory));
    std::vector<std::string> inputs = container.facts.files;
    if (!o.image.empty()) inputs.push_back(o.image);
    check_distinct(inputs, outputs_of(o));
    const MeshImage& mesh_image = container.mesh_image;
    if (split_names(mesh_image.source.channel_names).color.empty())
        throw Error(ErrorKind::kUnsupported, cat(o.input, ": the container has no colour"));
    check_level("--level", o.level, o.input, mesh_image);
    const Level& level = mesh_image.levels[static_cast<std::size_t>(o.level)];

    context.memory.take_for(o.input, mesh_image, kSegmentBytes);
    SegmentParams params = o.params;
    params.threshold = o.threshold.value_or(params.threshold);
    params.compactness = o.compactness.value_or(params.compactness);
    params.distance = o.distance.value_or(params.distance);
    const FeatureImage picture = picture_of(o, mesh_image, level, context);
    const Segmentation result = segment(level, picture, params, [&](double f, std::string_view stage) {
        context.progress(0.3 + 0.4 * f, stage);
    });
    std::vector<std::string> missed;
    if (!result.missed.empty())
        missed = {cat(o.params.superpixels ? "--superpixels: " : "--segments: ", result.missed)};
    tell_missed(o.input, missed, o.strict, context.warnings);
    const LabelImage& labels = result.labels;
    const std::vector<RegionFacts> facts = region_facts(labels, picture);

    context.progress(0.8, "write");
    JointFiles together;
    write_labels(o.output, labels.width, labels.height, labels.values, context.overwrite);
    if (!o.outlines.empty())
        write_image(o.outlines, draw_outlines(labels, picture, mesh_image.source), {context.overwrite, {}});
    if (!o.flat.empty())
        write_image(o.flat, draw_flat(labels, mean_colors(facts), mesh_image.source),
                    {context.overwrite, {}});
    if (!o.ucm.empty()) {
        const ContourMap map = contour_map(result.cells, result.hierarchy);
        write_contours(o.ucm, map.width, map.height, map.values, SegmentParams{}.threshold,
                       context.overwrite);
    }
    if (!o.report.empty())
        write_text(o.report, regions_text(labels, facts, context.generator, o.input), context.overwrite);
    if (!o.mesh.empty())
        write_region_mesh(o.mesh, level.mesh, region_of_faces(level.mesh, level.map, labels),
                          mesh_image.source, context.generator, context.overwrite);
    together.commit();

    Report report = {
        {"input", o.input},
        {"output", o.output},
        {"level", o.level},
        {"distance", params.superpixels ? "superpixels" : name_of(distance_choices(), params.distance)}};
    report.update(segmentation_report(result, facts));
    report.update(target_report(missed));
    const std::pair<const char*, const std::string*> others[] = {
        {"image", &o.image}, {"outlines", &o.outlines}, {"flat", &o.flat},
        {"ucm", &o.ucm},     {"report", &o.report},     {"mesh", &o.mesh}};
    for (const auto& [name, path] : others)
        if (!path->empty()) report[name] = *path;
    return report;
}

void print(const Report& report, std::ostream& out) {
    out << printable_line(report["input"].get<std::string>() + " -> " + report["output"].get<std::string>())
        << '\n';
    TextTable table;
    const bool superpixels = report["distance"] == "superpixels";  // which follow pixels, not patches
    table.add("regions", superpixels ? cat(report["regions"], " superpixels")
                                     : cat(report["regions"], " of ", report["cells"], " connected patches"));
    table.add("sizes", cat(report["min_pixels"], " to ", report["max_pixels"], " pixels"));
    if (!superpixels)
        table.add("distance", cat(report["distance"].get<std::string>(), ", merged up to ",
                                  format_number(report["merged_up_to"].get<double>())));
    table.print(out, 2);
}

std::string line(const Report& report) {
    return cat(report["regions"], " regions of ", report["min_pixels"], " to ", report["max_pixels"],
               " pixels");
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    return tool_main<Options>(
        {.name = "imgmesh-segment",
         .description = "Cut the images of containers into regions.",
         .input_name = "CONTAINER",
         .input_help = "Containers to read (.glb, .gltf)",
         .output_help = "Labels to write, as .exr (UINT id), .tif (32 bit), .npy (uint32), .mat (segs) or "
                        ".png (16 bit), "
                        "or a folder, ended by /, for NAME.png "
                        "of each container; with several containers the other outputs are folders as well",
         .type = [] { return "png"; },
         .sources = {"--image"}},
        {add_options,
         check_options,
         segment_one,
         print,
         line,
         {{"--outlines", "png", &Options::outlines},
          {"--flat", "png", &Options::flat},
          {"--ucm", "exr", &Options::ucm, {"npy", "mat"}},
          {"--report", "json", &Options::report},
          {"--mesh", "glb", &Options::mesh}}},
        options, argc, argv);
}
