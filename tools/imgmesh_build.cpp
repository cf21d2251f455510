// imgmesh-build: images in, containers out.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "formats/container/container.h"
#include "formats/picture/image_io.h"
#include "libcore/base/parallel.h"
#include "libcore/base/stopwatch.h"
#include "libcore/mesh/outer_edge.h"
#include "libcore/pipeline/build_source.h"
#include "tools/build_jobs.h"
#include "tools/build_memory.h"
#include "tools/build_options.h"
#include "tools/build_report.h"
#include "tools/common/in_file.h"
#include "tools/common/joint_progress.h"
#include "tools/common/memory.h"
#include "tools/common/output.h"
#include "tools/common/read_options.h"
#include "tools/common/tool_main.h"

namespace fs = std::filesystem;
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

Report build_one(const Job& job, const BuildOptions& o, const Context& context, MemoryGate& gate,
                 const Progress& progress, std::vector<std::string>& warnings) {
    Stopwatch whole, stage;
    check_output(job.output, context.overwrite);
    const ReadImage read = read_with_warnings(job.input, read_options(o), warnings);
    const Image& image = read.image;
    const auto add_warning = [&](const std::string& text) { warnings.push_back(cat(job.input, ": ", text)); };
    const SourcePlan plan = plan_source(image, o.alpha, !o.mask.empty(), o.params, option_text);
    for (const std::string& warning : plan.warnings) add_warning(warning);
    const bool keep = plan.alpha == AlphaUse::kKeep;
    const double bytes = build_memory(image, plan.params);
    check_memory(cat(job.input, ": a build of ", image.width, "x", image.height, " pixels"), bytes,
                 context.max_memory);
    const MemoryGate::Share share(gate, bytes);
    Mask mask = mask_of(image, job.input, plan, o, warnings);
    const bool missing = !read.data.empty(), mask_is_data = missing && mask.empty();
    if (missing) mask = in_file(job.input, [&] { return in_both(mask, read.data); });
    const double read_seconds = stage.lap();
    ContainerOptions container;
    container.draco = o.draco;
    container.overwrite = context.overwrite;
    container.metadata = read.metadata;
    if (o.texture.wanted)
        container.texture.picture = in_file(job.input, [&] {
            return encode_texture(image, mask, o.texture.type,
                                  keep ? TextureAlpha::kOwn : TextureAlpha::kMask);
        });
    BuildResult result =
        in_file(job.input, [&] { return build_mesh_image(image, plan.params, progress, std::move(mask)); });
    result.mesh_image.generator = context.generator;
    const MaskOrigin origin = mask_is_data     ? MaskOrigin::kNoData
                              : o.mask.empty() ? MaskOrigin::kAlpha
                                               : MaskOrigin::kPicture;
    const std::string clipped = note_source(result, origin, plan.threshold, option_text);
    if (!clipped.empty()) add_warning(clipped);
    stage.lap();
    if (o.texture.wanted) {
        extend_to_outer_edge(result.mesh_image);
        container.texture.coords = texture_coords(result.mesh_image);
    }
    write_container(job.output, result.mesh_image, container);
    const double write_seconds = stage.lap();

    // The figures are those that a reader of the container gets.
    const Container written = read_container(job.output);
    Report report = {{"input", job.input}, {"output", job.output}};
    const char* use = image.channel("A") < 0         ? "none"
                      : keep                         ? "kept"
                      : plan.alpha == AlphaUse::kCut ? "cut"
                                                     : "ignored";
    report.update(image_report(image, use, o.params.values, result.report, written,
                               {read_seconds, write_seconds, whole.lap()}));
    report.update(read_report(read));
    return report;
}

Report run(const BuildOptions& given, Context& context) {
    BuildOptions o = given;
    o.read.limits.max_memory = context.max_memory;
    o.read.limits.work_bytes = build_bytes_of_pixel(o.params);
    const std::vector<Job> jobs = plan_jobs(o);
    if (!fs::path(o.output).has_filename()) make_folder(o.output);

    std::vector<Report> images(jobs.size());
    std::vector<std::optional<Failure>> failures(jobs.size());
    std::vector<std::vector<std::string>> warnings(jobs.size());
    MemoryGate gate(context.max_memory);
    JointProgress progress(jobs.size(), context.progress);
    parallel_blocks(0, static_cast<int>(jobs.size()), 1, [&](int begin, int) {
        const auto i = static_cast<std::size_t>(begin);
        try {
            const auto show = [&](double fraction, std::string_view stage) {
                progress.show(i, fraction, stage);
            };
            images[i] = build_one(jobs[i], o, context, gate, show, warnings[i]);
        } catch (...) {
            // A bad image does not stop the others.
            failures[i] = current_failure();
            if (failures[i]->code == ExitCode::kInternal)
                failures[i]->message = cat(jobs[i].input, ": ", failures[i]->message);
            images[i] = {{"input", jobs[i].input},
                         {"failure", {{"code", failures[i]->code}, {"message", failures[i]->message}}}};
        }
        progress.show(i, 1, "done");
    });
    for (const auto& list : warnings)
        context.warnings.insert(context.warnings.end(), list.begin(), list.end());
    for (const std::optional<Failure>& failure : failures) {
        if (failure) context.failures.push_back(*failure);
    }
    return {{"images", images}};
}

}  // namespace

int main(int argc, char** argv) {
    return tool_main<BuildOptions>("imgmesh-build",
                                   "Turn images into containers: a small triangle mesh and a pixel map.",
                                   argc, argv, add_build_options, run, print_build);
}
