// imgmesh-build: images in, containers out.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "formats/container/container.h"
#include "formats/picture/image_io.h"
#include "libcore/base/parallel.h"
#include "libcore/base/stopwatch.h"
#include "libcore/mesh/outer_edge.h"
#include "libcore/pipeline/build.h"
#include "tools/build_jobs.h"
#include "tools/build_mask.h"
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

// The threshold of masks: half, as everywhere.
constexpr double kOpaqueEnough = 0.5;

// What becomes of an image's alpha: AlphaUse, but never kAuto.
AlphaUse alpha_use(const Image& image, const BuildOptions& o) {
    const auto& channels = o.params.channels;
    const bool left_out =
        !channels.empty() && std::ranges::find(channels, "A", &ChannelChoice::name) == channels.end();
    if (image.channel("A") < 0) return AlphaUse::kIgnore;
    // Values have a mask beside them, which --channels A makes one of them.
    if (o.params.values && o.alpha == AlphaUse::kAuto)
        return o.mask.empty() ? AlphaUse::kCut : AlphaUse::kIgnore;
    if (o.alpha == AlphaUse::kKeep) return AlphaUse::kKeep;
    if (o.alpha == AlphaUse::kIgnore || !o.mask.empty()) return AlphaUse::kIgnore;
    if (o.alpha == AlphaUse::kCut || left_out) return AlphaUse::kCut;
    return has_soft_alpha(image) ? AlphaUse::kKeep : AlphaUse::kCut;
}

// Adds alpha to the channels of the mesh. Refinement is for colour alone: where nobody has asked for the
// alpha, it is left out with a warning instead of an error.
void keep_alpha(const Image& image, const std::string& input, bool asked, BuildParams& p,
                std::vector<std::string>& warnings) {
    if (p.channels.empty())
        for (const std::string& name : split_names(image.channel_names).color)
            p.channels.push_back({name, 1});
    if (std::ranges::find(p.channels, "A", &ChannelChoice::name) == p.channels.end())
        p.channels.push_back({"A", kAlphaWeight});
    if (asked || (p.refine.value_or(0) == 0 && p.objective == Objective::kLuv)) return;
    p.refine = 0;
    p.objective = Objective::kLuv;
    warnings.push_back(
        cat(input, ": its soft alpha is kept, and so the mesh is not refined; --alpha cut refines it"));
}

// Returns the least alpha, or brightness of a mask, of the pixels that are meshed.
float mask_threshold(const Image& image, const std::string& input, AlphaUse alpha, const BuildOptions& o,
                     std::vector<std::string>& warnings) {
    if (o.alpha_threshold) return static_cast<float>(*o.alpha_threshold);
    if (alpha != AlphaUse::kKeep || !o.mask.empty()) return kOpaqueEnough;
    const float least = least_visible_alpha(image);
    if (least > kVisibleAlpha)
        warnings.push_back(
            cat(input,
                ": its specks with an alpha below 8/255 are left out; --alpha-threshold 0.002 keeps them"));
    return least;
}

// Returns the mask of --mask, or of alpha; empty() for none.
Mask mask_of(const Image& image, const std::string& input, AlphaUse alpha, float threshold,
             const BuildOptions& o, std::vector<std::string>& warnings) {
    if (!o.mask.empty()) return read_mask(o.mask, threshold, o.read.limits, image, input, warnings);
    if (alpha == AlphaUse::kIgnore) return {};
    Mask mask = alpha_mask(image, threshold);
    if (!mask.empty() && mask.count() == 0)
        throw Error(ErrorKind::kUnsupported,
                    cat(input, ": no pixel is inside the mask: alpha is below ", threshold,
                        " everywhere; --alpha ignore meshes the colours without it"));
    return mask;
}

// Returns how to read the images: no more channels than are meshed.
ReadImageOptions read_options(const BuildOptions& o) {
    ReadImageOptions read = o.read;
    // A texture shows the colour also where other channels are meshed.
    if (o.texture.wanted && !o.params.channels.empty()) return read;
    if (o.params.values && o.params.channels.empty()) return read;  // all are meshed
    read.channels.emplace();
    for (const ChannelChoice& choice : o.params.channels) read.channels->push_back(choice.name);
    return read;
}

// The parameters with the names that channels have once they are read.
BuildParams named_as_read(BuildParams params) {
    if (params.values)
        for (ChannelChoice& channel : params.channels) channel.name = value_name(channel.name);
    return params;
}

Report build_one(const Job& job, const BuildOptions& o, const Context& context, MemoryGate& gate,
                 const Progress& progress, std::vector<std::string>& warnings) {
    Stopwatch whole, stage;
    check_output(job.output, context.overwrite);
    const ReadImage read = read_with_warnings(job.input, read_options(o), warnings);
    const Image& image = read.image;
    const AlphaUse alpha = alpha_use(image, o);
    const bool keep = alpha == AlphaUse::kKeep;
    BuildParams params = named_as_read(o.params);
    if (keep) keep_alpha(image, job.input, o.alpha == AlphaUse::kKeep, params, warnings);
    const double bytes = build_memory(image, params);
    check_memory(cat(job.input, ": a build of ", image.width, "x", image.height, " pixels"), bytes,
                 context.max_memory);
    const MemoryGate::Share share(gate, bytes);
    const float threshold = mask_threshold(image, job.input, alpha, o, warnings);
    Mask mask = mask_of(image, job.input, alpha, threshold, o, warnings);
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
        in_file(job.input, [&] { return build_mesh_image(image, params, progress, std::move(mask)); });
    result.mesh_image.generator = context.generator;
    if (result.mesh_image.source.has_mask) {
        const char* of = mask_is_data ? "nodata" : o.mask.empty() ? "alpha" : "picture";
        result.mesh_image.parameters.emplace_back("mask", std::string(of));
        if (!mask_is_data)
            result.mesh_image.parameters.emplace_back("alpha-threshold",
                                                      o.alpha_threshold.value_or(threshold));
    }
    if (result.report.clipped_samples > 0)
        warnings.push_back(
            cat(job.input, ": ", result.report.clipped_samples,
                " samples of its colours are below 0 or too large and were clipped; --values keeps "
                "numbers as they are"));
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
    const char* use = image.channel("A") < 0    ? "none"
                      : keep                    ? "kept"
                      : alpha == AlphaUse::kCut ? "cut"
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
