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
#include "formats/tileset/tile_set_files.h"
#include "libcore/image/color.h"
#include "libcore/image/feature_space.h"
#include "libcore/segment/contour_hierarchy.h"
#include "libcore/segment/contour_map.h"
#include "libcore/segment/draw_regions.h"
#include "libcore/segment/region_colors.h"
#include "libcore/segment/region_faces.h"
#include "libcore/segment/regions_svg.h"
#include "libcore/segment/segment.h"
#include "tools/common/choices.h"
#include "tools/common/container_input.h"
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
#include "tools/segment_options.h"
#include "tools/segment_report.h"
#include "tools/tiles/set_segment.h"

using namespace imgmesh;

namespace {

// Reading, segmenting and writing take this, beside the container itself [bytes a pixel]; measured as in
// docs/limits.md.
constexpr double kSegmentBytes = 66;
// A contour map is a whole .mat before that is compressed.
constexpr double kMatBytes = 16;

FeatureImage picture_of(const SegmentOptions& o, const MeshImage& mesh_image, const Level& level,
                        Context& context) {
    if (o.image.empty()) return reconstruct_luv(level);
    return luv_image(read_source_image(o.image, mesh_image.source, o.input,
                                       image_options(o.read, o.limits, context.max_memory), context.warnings),
                     Range::kClipped);
}

double bytes_a_pixel(const SegmentOptions& o, const Level& level) {
    const bool measured =
        !o.params.superpixels && o.distance != DistanceRule::kPaper && o.quality != SegmentQuality::kFast;
    return kSegmentBytes + (lower_extension(o.ucm) == ".mat" ? kMatBytes : 0) +
           (measured ? contour_memory(level.map) / double(level.map.pixel_count()) : 0);
}

Report segment_one(const SegmentOptions& o, Context& context) {
    if (is_tile_set(o.input)) return segment_set(o, context);
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

    context.memory.take_for(o.input, mesh_image, bytes_a_pixel(o, level));
    const SegmentParams params = params_of(o);
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
    const Mask mask = o.mask.empty() ? Mask() : choose_by_seeds(result, o.seeds);

    context.progress(0.8, "write");
    JointFiles together;
    write_labels(o.output, labels.width, labels.height, labels.values, context.overwrite);
    if (!o.outlines.empty())
        write_image(o.outlines, draw_outlines(labels, picture, mesh_image.source), {context.overwrite, {}});
    if (!o.flat.empty())
        write_image(o.flat, draw_flat(labels, mean_colors(facts), mesh_image.source),
                    {context.overwrite, {}});
    if (!o.colors.empty())
        write_image(o.colors, draw_colors(labels, distinct_colors(facts)), {context.overwrite, {}});
    if (!o.svg.empty())
        write_text(o.svg, regions_svg(region_outlines(labels, o.svg_tolerance), mean_colors(facts)),
                   context.overwrite);
    if (!o.mask.empty()) write_image(o.mask, mask_image(mask), {context.overwrite, {}});
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
        {"image", &o.image},   {"outlines", &o.outlines}, {"flat", &o.flat},
        {"colors", &o.colors}, {"svg", &o.svg},           {"ucm", &o.ucm},
        {"report", &o.report}, {"mesh", &o.mesh},         {"mask", &o.mask}};
    for (const auto& [name, path] : others)
        if (!path->empty()) report[name] = *path;
    if (!mask.empty()) report["mask_pixels"] = mask.count();
    return report;
}

void print(const Report& report, std::ostream& out) {
    out << printable_line(report["input"].get<std::string>() + " -> " + report["output"].get<std::string>())
        << '\n';
    TextTable table;
    const bool superpixels = report["distance"] == "superpixels";  // which follow pixels, not patches
    table.add("regions", superpixels ? cat(report["regions"], " superpixels")
                                     : cat(report["regions"], " of ", report["cells"], " cells"));
    if (report.contains("tiles"))
        table.add("tiles", cat(report["tiles"], ", ", report["joined"], " regions in several"));
    table.add("sizes", cat(report["min_pixels"], " to ", report["max_pixels"], " pixels"));
    if (!superpixels)
        table.add("distance", cat(report["distance"].get<std::string>(), ", merged up to ",
                                  format_number(report["merged_up_to"].get<double>())));
    if (report.contains("mask_pixels")) table.add("mask", cat(report["mask_pixels"], " pixels are kept"));
    table.print(out, 2);
}

std::string line(const Report& report) {
    return cat(report["regions"], " regions of ", report["min_pixels"], " to ", report["max_pixels"],
               " pixels");
}

}  // namespace

int main(int argc, char** argv) {
    SegmentOptions options;
    return tool_main<SegmentOptions>(
        {.name = "imgmesh-segment",
         .description = "Cut the images of containers into regions.",
         .input_name = "CONTAINER",
         .input_help = "Containers to read (.glb, .gltf), or tile sets (a folder with index.json)",
         .output_help = "Labels to write, as .exr (UINT id), .tif (32 bit), .npy (uint32), .mat (segs) or "
                        ".png (16 bit), "
                        "or a folder, ended by /, for NAME.png "
                        "of each container; with several containers the other outputs are folders as well",
         .type = [] { return "png"; },
         .sources = {"--image"}},
        {add_segment_options,
         check_segment_options,
         segment_one,
         print,
         line,
         {{"--outlines", "png", &SegmentOptions::outlines},
          {"--flat", "png", &SegmentOptions::flat},
          {"--colors", "png", &SegmentOptions::colors},
          {"--svg", "svg", &SegmentOptions::svg},
          {"--ucm", "exr", &SegmentOptions::ucm, {"npy", "mat"}},
          {"--report", "json", &SegmentOptions::report},
          {"--mesh", "glb", &SegmentOptions::mesh},
          {"--mask", "png", &SegmentOptions::mask}}},
        options, argc, argv);
}
