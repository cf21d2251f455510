// imgmesh-build: images in, containers out.
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <ostream>

#include "formats/container/container.h"
#include "formats/files/extension.h"
#include "formats/picture/image_io.h"
#include "libcore/base/parallel.h"
#include "libcore/base/stopwatch.h"
#include "libcore/image/color.h"
#include "libcore/metrics/metrics.h"
#include "libcore/pipeline/build.h"
#include "libcore/pipeline/presets.h"
#include "tools/build_contradictions.h"
#include "tools/common/channel_list.h"
#include "tools/common/names.h"
#include "tools/common/options.h"
#include "tools/common/output.h"
#include "tools/common/text.h"
#include "tools/common/texture_options.h"
#include "tools/common/tool_main.h"

namespace fs = std::filesystem;
using namespace imgmesh;

namespace {

struct Options {
    std::vector<std::string> inputs;
    std::string output;
    BuildParams params;
    DracoMode draco = DracoMode::kEdgebreaker;
    std::optional<ColorSpace> color_space;
    bool cut = true;  // along alpha
    std::string mask;
    double alpha_threshold = 0.5;
    TextureOptions texture;
    ImageLimits limits;
};

Choices<MapKind> map_choices() {
    return {{"relaxed", MapKind::kRelaxed}, {"tracked", MapKind::kTracked}, {"trivial", MapKind::kTrivial}};
}

struct Job {
    std::string input;
    std::string output;
};

void add_options(CLI::App& app, Options& o) {
    add_inputs(app, "IMAGE", o.inputs, "Images to read");
    add_output(app, o.output,
               "Container to write (.glb, .gltf), or a folder, ended by /, for NAME.glb of each");
    // Before all that it sets, so that other options, wherever they stand, count after it.
    add_choice<BuildParams, BuildParams>(app, "--preset", o.params,
                                         {{"fast", preset_params(Preset::kFast)},
                                          {"default", preset_params(Preset::kDefault)},
                                          {"best", preset_params(Preset::kBest)},
                                          {"fem", preset_params(Preset::kFem)}},
                                         "Values of the options below, for speed, as usual, for the lowest "
                                         "error of the mesh drawn alone, or for "
                                         "triangles of good shape");
    add_channels(app, o.params.channels);
    const StopParams stop;
    CLI::Option* const faces = add_count(app, "--faces", o.params.stop.faces, {2}, "Stop at this many faces");
    CLI::Option* const vertices =
        add_count(app, "--vertices", o.params.stop.vertices, {4}, "Stop at this many vertices");
    CLI::Option* const error =
        add_number(app, "--error", o.params.stop.error, {0}, "Stop before a quadric error above this");
    CLI::Option* const density =
        add_number(app, "--density", o.params.stop.density, {0, 100, true},
                   cat("Stop at this many vertices, in percent of the pixels (default ", stop.density, ")"));
    CLI::Option* const rms = add_number(app, "--rms", o.params.stop.rms, {0},
                                        "Stop at an RMS of the reconstruction of at most this, in L*u*v*");
    density->excludes(faces)->excludes(vertices)->excludes(error);
    CLI::Option* const levels =
        add_count(app, "--levels", o.params.levels.count, {1, kMaxLevels},
                  "Levels of the pyramid, each with a quarter of the faces of the one before (default 1)");
    CLI::Option* const level_faces = add_list<std::int64_t>(
        app, "--level-faces", o.params.levels.faces,
        [](const std::string& item) { return parse_count("--level-faces", item, {2}); },
        "Faces of each level, as 8000,2000,500");
    CLI::Option* const level_errors = add_list<double>(
        app, "--level-errors", o.params.levels.errors,
        [](const std::string& item) { return parse_number("--level-errors", item, {0}); },
        "Quadric error of each level, as 100,1000");
    level_faces->excludes(levels)->excludes(faces)->excludes(vertices)->excludes(error)->excludes(density);
    level_errors->excludes(level_faces)
        ->excludes(levels)
        ->excludes(faces)
        ->excludes(vertices)
        ->excludes(error)
        ->excludes(density);
    rms->excludes(faces)
        ->excludes(vertices)
        ->excludes(error)
        ->excludes(density)
        ->excludes(levels)
        ->excludes(level_faces)
        ->excludes(level_errors);
    add_count(app, "--max-cluster", o.params.max_cluster, {3},
              "Pixels a face has at most, whatever the limits above say");
    add_number(
        app, "--min-quality", o.params.min_quality, {0, 0.8},
        "Least q = 4 sqrt(3) area / sum of squared edges of a triangle, whatever the limits above say");
    const BuildParams params;
    add_count(
        app, "--refine", o.params.refine, {0, kMaxRefine},
        cat("Rounds that move vertices, flip edges and put vertices elsewhere to lower the error (default ",
            kUsualRefine, ")"));
    add_number(app, "--shape-weight", o.params.shape_weight, {0},
               cat("Weight of the triangles' shape against error in refinement (default ",
                   params.shape_weight, ")"));
    add_number(app, "--exchange", o.params.exchange, {0, 1},
               cat("Share of the vertices that each round of refinement adds and takes away elsewhere; slow "
                   "(default ",
                   params.exchange, ")"));
    add_choice<Objective, Objective>(
        app, "--objective", o.params.objective, {{"luv", Objective::kLuv}, {"rgb", Objective::kRgb}},
        "Error to lower: L*u*v*, or sRGB with colours for the mesh drawn alone (default luv)");
    add_choice(app, "--metric", o.params.metric, metric_choices(),
               "Error that collapses are ordered and placed by (default flattened)");
    add_choice(app, "--solver", o.params.solver, solver_choices(),
               "How a quadric's least point is found; closed is the fast one (default closed)");
    add_number(app, "--geometry-weight", o.params.geometry_weight, {0, kNoLimit, true},
               cat("Weight of geometry in the quadrics (default ", params.geometry_weight, ")"));
    add_number(app, "--color-weight", o.params.color_weight, {0, kNoLimit, true},
               cat("Weight of colour in the quadrics (default ", params.color_weight, ")"));
    app.final_callback([&] { check_contradictions(app, o.params); });
    add_count(app, "--smoothing", o.params.smoothing, {0, kMaxSmoothing},
              "Passes of smoothing before gradients are taken (default by density for flattened, else 0)");
    add_choice<bool, bool>(
        app, "--quadrics", o.params.rebuild_quadrics, {{"accumulated", false}, {"rebuilt", true}},
        "Summed up from the pixels on, or taken anew from the mesh at every halving (default accumulated)");
    add_choice<std::optional<bool>, bool>(
        app, "--priority", o.params.total_priority, {{"increment", false}, {"total", true}},
        "Edges go by the error that a collapse adds, or by its total (default increment "
        "for flattened, else total)");
    add_choice(
        app, "--map", o.params.map, map_choices(),
        "How pixels find their places: fitted without a fold, carried through every collapse as in the "
        "paper, or none moved (default relaxed)");
    BuildParams tracked;
    tracked.map = MapKind::kTracked;
    CLI::Option* const projection =
        add_number(app, "--projection-color-weight", o.params.projection_color_weight, {0},
                   cat("Weight of colour in the pixel map, 0 for the trivial map (default ",
                       format_number(map_color_weight(params)), ", tracked ",
                       format_number(map_color_weight(tracked)), ")"));
    add_value(
        app, "--map-smoothness", "X",
        [&o](const std::string& text) {
            o.params.projection_color_weight = 1 / parse_number("--map-smoothness", text, {1e-9, 1e12});
        },
        cat("Smoothness of the pixel map against colour: 1 / projection color weight (default ",
            format_number(1 / map_color_weight(params)), ")"))
        ->excludes(projection);
    app.add_flag("--visits", o.params.visits, "Store how often the collapse touched each pixel");
    add_choice<bool, bool>(
        app, "--colors", o.params.quadric_colors, {{"fitted", false}, {"quadric", true}},
        "Vertex colours: of least squares, or of the quadrics, as in the paper (default fitted)");
    add_choice(app, "--bary", o.params.bary, bary_choices(),
               "Precision of the pixel map (default half where the map stays one to one, else float)");
    add_choice(app, "--draco", o.draco, draco_choices(), "Mesh compression (default edgebreaker)");
    add_texture_options(app, o.texture, "Put the image on the meshes, for engines and viewers", false);
    add_choice(app, "--color-space", o.color_space, color_space_choices(),
               "Of the images' numbers, whatever their files say");
    add_count(app, "--max-pixels", o.limits.max_pixels, {1},
              cat("Refuse a larger image (default ", o.limits.max_pixels, ")"));
    add_choice<bool, bool>(app, "--alpha", o.cut, {{"cut", true}, {"ignore", false}},
                           "What becomes of an alpha channel: only pixels that it shows are meshed, or all "
                           "(default cut)");
    add_value(
        app, "--mask", "FILE",
        [&o](const std::string& text) {
            if (text.empty()) throw Error(ErrorKind::kBadArgument, "--mask '': expected a file name");
            o.mask = text;
        },
        "Image of the images' size: only pixels that its alpha, or else its light, shows are meshed, "
        "whatever their own alpha says");
    add_number(
        app, "--alpha-threshold", o.alpha_threshold, {0, 1, true},
        cat("Alpha, or light of a mask, from which on a pixel is meshed (default ", o.alpha_threshold, ")"));
}

// Which container each image goes to. Throws Error(kBadArgument) for what can be seen to be wrong before
// any work.
std::vector<Job> plan_jobs(const Options& o) {
    std::vector<Job> jobs;
    const bool folder = o.output.ends_with('/') || fs::is_directory(o.output);
    if (!folder) {
        if (o.inputs.size() > 1)
            throw Error(ErrorKind::kBadArgument, cat("-o ", o.output, ": ", o.inputs.size(),
                                                     " images need a folder, whose name ends with /"));
        const std::string extension = lower_extension(o.output);
        if (extension != ".glb" && extension != ".gltf")
            throw Error(ErrorKind::kBadArgument,
                        cat("-o ", o.output, ": expected a name in .glb or .gltf, or a folder"));
        jobs.push_back({o.inputs.front(), o.output});
    } else {
        std::map<std::string, std::string> input_of;
        for (const std::string& input : o.inputs) {
            const std::string output = fs::path(o.output) / (fs::path(input).stem().string() + ".glb");
            const auto [entry, is_new] = input_of.emplace(output, input);
            if (!is_new)
                throw Error(ErrorKind::kBadArgument,
                            cat(entry->second, " and ", input, " would both become ", output));
            jobs.push_back({input, output});
        }
    }
    std::vector<std::string> outputs;
    for (const Job& job : jobs) {
        for (std::string& file : container_files(job.output)) outputs.push_back(std::move(file));
    }
    check_distinct(o.inputs, outputs);
    if (!o.mask.empty()) check_distinct({o.mask}, outputs);
    return jobs;
}

// The library knows no file; its refusals get the image's name here.
BuildResult build_named(const std::string& input, const Image& image, const BuildParams& params,
                        const Progress& progress, Mask mask) {
    try {
        return build_mesh_image(image, params, progress, std::move(mask));
    } catch (const Error& e) {
        throw Error(e.kind(), cat(input, ": ", e.what()));
    }
}

// What --mask says; empty() without it.
Mask read_mask(const Options& o) {
    if (o.mask.empty()) return {};
    const Image picture = read_image(o.mask, {}, o.limits);
    try {
        return image_mask(picture, static_cast<float>(o.alpha_threshold));
    } catch (const Error& e) {
        throw Error(e.kind(), cat(o.mask, ": ", e.what()));
    }
}

Report build_one(const Job& job, const Options& o, const Context& context, const Progress& progress) {
    Stopwatch whole, stage;
    check_output(job.output, context.overwrite);
    const Image image = read_image(job.input, o.color_space, o.limits);
    const bool cut = o.cut && o.mask.empty();
    Mask mask = cut ? alpha_mask(image, static_cast<float>(o.alpha_threshold)) : read_mask(o);
    const double read_seconds = stage.lap();
    ContainerOptions container;
    container.draco = o.draco;
    container.overwrite = context.overwrite;
    if (o.texture.wanted) {
        try {
            container.texture.picture = encode_texture(image, mask, o.texture.type);
        } catch (const Error& e) {
            throw Error(e.kind(), cat(job.input, ": ", e.what()));
        }
    }
    BuildResult result = build_named(job.input, image, o.params, progress, std::move(mask));
    result.mesh_image.generator = context.generator;
    if (result.mesh_image.source.has_mask) {
        result.mesh_image.parameters.emplace_back("mask", std::string(cut ? "alpha" : "picture"));
        result.mesh_image.parameters.emplace_back("alpha-threshold", o.alpha_threshold);
    }
    stage.lap();
    if (o.texture.wanted) container.texture.coords = texture_coords(result.mesh_image);
    write_container(job.output, result.mesh_image, container);
    const double write_seconds = stage.lap();

    // The figures are those of what a reader gets.
    const Container written = read_container(job.output);
    Report levels = Report::array();
    const std::vector<std::string> plain = split_names(written.mesh_image.source.channel_names).auxiliary;
    for (std::size_t k = 0; k < written.mesh_image.levels.size(); ++k) {
        const Level& level = written.mesh_image.levels[k];
        levels.push_back({{"vertices", level.mesh.vertex_count()},
                          {"faces", level.mesh.faces.size()},
                          {"error", level.error},
                          {"map_rms", result.report.levels[k].map_rms},
                          {"gouraud_rms", result.report.levels[k].gouraud_rms},
                          {"flipped_pixel_triangles", map_quality(level.mesh, level.map).flipped_triangles},
                          {"mean_edge_ratio", mesh_quality(level.mesh).mean_edge_ratio}});
        for (std::size_t c = 0; c < plain.size(); ++c)
            levels.back()["channel_rms"][plain[c]] = result.report.levels[k].auxiliary_rms[c];
    }
    const double bytes = static_cast<double>(written.facts.total_bytes);
    const BuildSeconds& seconds = result.report.seconds;
    Report report{{"input", job.input},
                  {"output", job.output},
                  {"width", image.width},
                  {"height", image.height},
                  {"color_space", color_space_name(image.color_space)},
                  {"has_light", written.mesh_image.source.gamut == Gamut::kHdr},
                  {"alpha", image.channel("A") < 0 ? "none"
                            : cut                  ? "cut"
                                                   : "ignored"},
                  {"pixels", result.report.pixels}};
    report.update(levels.front());  // the finest level's figures are the image's
    report.update({{"levels", levels},
                   {"bytes", written.facts.total_bytes},
                   {"bytes_per_pixel", bytes / static_cast<double>(image.pixel_count())},
                   {"seconds", whole.lap()},
                   {"stage_seconds",
                    {{"read", read_seconds},
                     {"collapse", seconds.collapse},
                     {"refine", seconds.refine},
                     {"map", seconds.map},
                     {"write", write_seconds}}}});
    return report;
}

// The share of all images that is done, from the shares of each, which come from several threads.
class JointProgress {
  public:
    JointProgress(std::size_t count, const Progress& progress)
        : fractions_(count, 0.0), progress_(progress) {}

    void show(std::size_t index, double fraction, std::string_view stage) {
        const std::lock_guard lock(mutex_);
        sum_ += fraction - fractions_[index];
        fractions_[index] = fraction;
        progress_(sum_ / static_cast<double>(fractions_.size()), stage);
    }

  private:
    std::mutex mutex_;
    std::vector<double> fractions_;
    double sum_ = 0;
    const Progress& progress_;
};

Report run(const Options& o, Context& context) {
    const std::vector<Job> jobs = plan_jobs(o);
    if (!fs::path(o.output).has_filename()) make_folder(o.output);

    std::vector<Report> images(jobs.size());
    std::vector<std::optional<Failure>> failures(jobs.size());
    JointProgress progress(jobs.size(), context.progress);
    parallel_blocks(0, static_cast<int>(jobs.size()), 1, [&](int begin, int) {
        const auto i = static_cast<std::size_t>(begin);
        try {
            images[i] = build_one(jobs[i], o, context, [&](double fraction, std::string_view stage) {
                progress.show(i, fraction, stage);
            });
        } catch (...) {
            // One bad image does not keep the others from being built.
            failures[i] = current_failure();
            if (failures[i]->code == ExitCode::kInternal)
                failures[i]->message = cat(jobs[i].input, ": ", failures[i]->message);
            images[i] = {{"input", jobs[i].input},
                         {"failure", {{"code", failures[i]->code}, {"message", failures[i]->message}}}};
        }
        progress.show(i, 1, "done");
    });
    for (const std::optional<Failure>& failure : failures) {
        if (failure) context.failures.push_back(*failure);
    }
    return {{"images", images}};
}

void print(const Report& report, std::ostream& out) {
    for (const Report& image : report["images"]) {
        if (image.contains("failure")) continue;
        out << printable_line(image["input"].get<std::string>() + " -> " + image["output"].get<std::string>())
            << '\n';
        const auto number = [&](const char* key) { return format_number(image[key].get<double>()); };
        TextTable table;
        table.add("size", cat(image["width"], " x ", image["height"], " pixels"));
        if (image["alpha"] != "none") table.add("alpha", image["alpha"].get<std::string>());
        if (image["pixels"] != image["width"].get<std::int64_t>() * image["height"].get<std::int64_t>())
            table.add("masked image", cat(image["pixels"], " pixels"));
        table.add("mesh", cat(image["vertices"], " vertices, ", image["faces"], " faces"));
        table.add("error",
                  cat("map ", number("map_rms"), ", Gouraud ", number("gouraud_rms"), " L*u*v* RMS"));
        if (image.contains("channel_rms"))
            for (const auto& [name, rms] : image["channel_rms"].items())
                table.add(printable_line(name), cat("map ", format_number(rms.get<double>()), " RMS"));
        for (std::size_t k = 1; k < image["levels"].size(); ++k) {
            const Report& level = image["levels"][k];
            table.add(cat("level ", k), cat(level["vertices"], " vertices, ", level["faces"], " faces, map ",
                                            format_number(level["map_rms"].get<double>()), ", Gouraud ",
                                            format_number(level["gouraud_rms"].get<double>())));
        }
        table.add("edge ratio", number("mean_edge_ratio"));
        table.add("flipped", cat(image["flipped_pixel_triangles"], " pixel triangles"));
        table.add("file", cat(format_bytes(image["bytes"].get<std::uint64_t>()), ", ",
                              number("bytes_per_pixel"), " bytes per pixel"));
        table.add("time", cat(number("seconds"), " s"));
        table.print(out, 2);
    }
}

}  // namespace

int main(int argc, char** argv) {
    return tool_main<Options>("imgmesh-build",
                              "Turn images into containers: a small triangle mesh and a pixel map.", argc,
                              argv, add_options, run, print);
}
