// imgmesh-build: images in, containers out.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "formats/container/container.h"
#include "formats/files/stream_file.h"
#include "formats/picture/image_io.h"
#include "libcore/base/stopwatch.h"
#include "libcore/mesh/outer_edge.h"
#include "libcore/pipeline/build_source.h"
#include "libcore/pipeline/lean_mesh.h"
#include "libcore/pipeline/targets.h"
#include "tools/build_memory.h"
#include "tools/build_options.h"
#include "tools/build_report.h"
#include "tools/common/container_input.h"
#include "tools/common/in_file.h"
#include "tools/common/other_tool.h"
#include "tools/common/output.h"
#include "tools/common/read_options.h"
#include "tools/common/targets.h"
#include "tools/common/tool_main.h"
#include "tools/tiles/tile_set_build.h"

using namespace imgmesh;

namespace {

// A parameter as it is given on the command line.
std::string option_text(std::string_view name, std::string_view value) {
    return cat("--", name, value.empty() ? "" : " ", value);
}

// Returns the mask of --mask, or of alpha; empty() for none.
Mask mask_of(const Image& image, const std::string& input, const SourcePlan& plan, const BuildOptions& o,
             std::vector<std::string>& warnings) {
    if (o.mask.empty()) return in_file(input, [&] { return source_mask(image, plan, option_text); });
    std::vector<std::string> own;
    const Image picture = read_with_warnings(o.mask, {.limits = o.read.limits}, own).image;
    Mask mask =
        in_file(o.mask, [&] { return picture_mask(picture, image, input, plan.threshold, option_text); });
    warnings.insert(warnings.end(), own.begin(), own.end());
    return mask;
}

// Returns how to read the images: no more channels than are meshed.
ReadImageOptions read_options(const BuildOptions& o) {
    ReadImageOptions read = o.read;
    read.channels = channels_to_read(o.params, o.texture.wanted.has_value());
    return read;
}

// Returns what is known before the work: levels may be left out, and only numbers of vertices are reached
// exactly.
ContainerPlan container_plan(const BuildParams& params, const Image& image, const Mask& mask) {
    const auto inside = mask.empty() ? static_cast<std::int64_t>(image.pixel_count()) : mask.count();
    const StopParams& stop = params.stop;
    ContainerPlan plan{static_cast<std::int64_t>(image.pixel_count()), 0};
    if (!stop.faces && !stop.error && !stop.rms && params.levels.faces.empty() &&
        params.levels.errors.empty())
        plan.vertices = std::min(inside, stop.vertices.value_or(static_cast<std::int64_t>(
                                             static_cast<double>(inside) * stop.density / 100)));
    return plan;
}

void check_options(const BuildOptions& o) {
    if (o.tiles.size) {
        // A folder of such a name would be taken for a container, or for standard output.
        if (stream_descriptor(o.output) >= 0 || is_container(o.output))
            throw Error(ErrorKind::kBadArgument,
                        cat("-o ", o.output, ": a tile set is a folder, expected a name as in out/"));
        return;
    }
    if (!is_container(o.output))
        throw Error(ErrorKind::kBadArgument,
                    cat("-o ", o.output, ": expected a name in .glb or .gltf, or a folder",
                        other_tool("imgmesh-build", o.output)));
    if (!o.mask.empty()) check_distinct({o.mask}, container_files(o.output, o.layers));
}

Report build_one(const BuildOptions& given, Context& context) {
    if (given.tiles.size) return build_tile_set(given, context);
    BuildOptions o = given;
    o.read.limits.max_memory = context.max_memory;
    o.read.limits.work_bytes = build_bytes_of_pixel(o.params);
    std::vector<std::string>& warnings = context.warnings;
    Stopwatch whole, stage;
    check_output(o.output, context.overwrite);
    ReadImage read = read_with_warnings(o.input, read_options(o), warnings);
    Image& image = read.image;
    const auto add_warning = [&](const std::string& text) { warnings.push_back(cat(o.input, ": ", text)); };
    const SourcePlan plan = plan_source(image, o.alpha, !o.mask.empty(), o.params, option_text);
    for (const std::string& warning : plan.warnings) add_warning(warning);
    const bool keep = plan.alpha == AlphaUse::kKeep;
    context.memory.take(cat(o.input, ": a build of ", image.width, "x", image.height, " pixels"),
                        build_memory(image, plan.params));
    Mask mask = mask_of(image, o.input, plan, o, warnings);
    const bool missing = !read.data.empty(), mask_is_data = missing && mask.empty();
    if (missing) mask = in_file(o.input, [&] { return in_both(mask, read.data); });
    ContainerOptions container;
    compress(container, o.compression, o.no_map ? DracoMode::kOff : DracoMode::kEdgebreaker);
    if (o.params.mesh_precision == MeshPrecision::kCompact && container.draco == DracoMode::kOff &&
        !container.meshopt)
        add_warning(
            "--mesh-precision compact: meshes without compression take the same bytes; --compression draco "
            "makes them smaller");
    container.layers = o.layers;
    const std::string doubt = check_buffer(o.output, container_plan(plan.params, image, mask), container);
    if (!doubt.empty()) warnings.push_back(doubt);
    const double read_seconds = stage.lap();
    container.overwrite = context.overwrite;
    container.metadata = read.metadata;
    if (o.texture.wanted)
        container.texture.picture = in_file(o.input, [&] {
            return encode_texture(image, mask, o.texture.type,
                                  keep ? TextureAlpha::kOwn : TextureAlpha::kMask);
        });
    Image shape{{image.width, image.height, image.channels, {}},
                image.channel_names,
                image.sample_type,
                image.color_space};
    BuildResult result = in_file(o.input, [&] {
        return build_mesh_image(std::move(image), plan.params, context.progress, std::move(mask));
    });
    const std::vector<std::string> missed = missed_targets(plan.params, result, o.density);
    tell_missed(o.input, missed, o.strict, context.warnings);
    result.mesh_image.generator = context.generator;
    const MaskOrigin origin = mask_is_data     ? MaskOrigin::kNoData
                              : o.mask.empty() ? MaskOrigin::kAlpha
                                               : MaskOrigin::kPicture;
    const std::string clipped = note_source(result, origin, plan.threshold, option_text);
    if (!clipped.empty()) add_warning(clipped);
    stage.lap();
    if (o.no_map)
        cover_whole_pixels(result.mesh_image);
    else if (o.texture.wanted) {
        extend_to_outer_edge(result.mesh_image);
        if (forget_position_steps(result.report))
            add_warning(
                "--texture stretches the mesh to the pixels' outer edge, which leaves positions on 1/32 "
                "pixel");
    }
    if (o.texture.wanted) container.texture.coords = texture_coords(result.mesh_image);
    const WrittenContainer files = write_container(o.output, result.mesh_image, container);
    const double write_seconds = stage.lap();

    // What a reader gets is what was written (write_container()), so nothing is read again.
    Container written;
    written.facts.total_bytes = size_of_files(files.files);
    written.facts.mesh_bytes = files.mesh_bytes;
    written.facts.layer_bytes = files.layer_bytes;
    written.facts.texture_bytes = container.texture.picture.size();
    written.mesh_image = std::move(result.mesh_image);
    std::ranges::sort(written.mesh_image.parameters, {}, &BuildParameter::first);  // as in the file
    Report report = {{"input", o.input}, {"output", o.output}};
    for (const auto& [name, value] : written.mesh_image.parameters)
        std::visit([&member = report["parameters"][name]](const auto& v) { member = v; }, value);
    const char* use = shape.channel("A") < 0         ? "none"
                      : keep                         ? "kept"
                      : plan.alpha == AlphaUse::kCut ? "cut"
                                                     : "ignored";
    report.update(image_report(shape, use, o.params.values, result.report, written,
                               {read_seconds, write_seconds, whole.lap()}));
    report.update(target_report(missed));
    report.update(read_report(read));
    return report;
}

// A report of a tile set has its size, one of an image its vertices.
void print_report(const Report& report, std::ostream& out) {
    report.contains("vertices") ? print_build(report, out) : print_tile_set(report, out);
}
std::string line_of(const Report& report) {
    return report.contains("vertices") ? build_line(report) : "";
}

}  // namespace

int main(int argc, char** argv) {
    BuildOptions options;
    options.tiles.command.assign(argv, argv + argc);
    return tool_main<BuildOptions>(
        {.name = "imgmesh-build",
         .description = "Turn images into containers: a small triangle mesh and a pixel map.",
         .input_name = "IMAGE",
         .input_help = "Images to read",
         .output_help =
             "Container to write (.glb, .gltf), or a folder, ended by /, for NAME.glb of each image",
         .type = [] { return "glb"; },
         .sources = {"--mask"},
         .fills_output = [&] { return options.tiles.size.has_value(); },
         .list = "images",
         .always_list = true},
        {add_build_options, check_options, build_one, print_report, line_of}, options, argc, argv);
}
