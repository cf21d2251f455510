// imgmesh-compare: compares two images or containers, or measures the quality of a container.
#include <algorithm>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "formats/container/container.h"
#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "formats/picture/image_io.h"
#include "libcore/image/color.h"
#include "libcore/image/feature_space.h"
#include "libcore/metrics/error_image.h"
#include "libcore/recon/draw_channels.h"
#include "tools/common/container_input.h"
#include "tools/common/limits.h"
#include "tools/common/memory.h"
#include "tools/common/names.h"
#include "tools/common/options.h"
#include "tools/common/output.h"
#include "tools/common/read_options.h"
#include "tools/common/text.h"
#include "tools/compare_report.h"

namespace fs = std::filesystem;
using namespace imgmesh;

namespace {

// Measures of a container, and the comparison of two images, take this [bytes a pixel]; measured as in
// docs/limits.md.
constexpr double kQualityBytes = 34, kPairBytes = 28, kChannelBytes = 8;

// Kodak photographs at 1 % vertices have an RMS of 4.5. Their usual errors are dark, visible ones bright.
constexpr double kErrorRange = 20;
// The scale of PNG plots, whose letters would be coarse at the size that suits an SVG.
constexpr int kPngScale = 2;
// The least alpha of a pixel with values.
constexpr float kVisible = std::numeric_limits<float>::min();

struct Options {
    std::string input, output, reference;
    std::optional<DrawMode> mode;
    std::optional<std::int64_t> level;
    ReadImageOptions read;
    ContainerLimits limits;
    std::optional<double> tolerance;
    std::string error_image;
    std::optional<double> error_range;
    std::string plot;
};

Choices<DrawMode> mode_choices() {
    return {{"map", DrawMode::kMap}, {"gouraud", DrawMode::kGouraud}};
}

void add_options(CLI::App& app, Options& o) {
    const std::string comparison = "Comparison", container = "Container", files = "Files";
    in_group(add_number(app, "--tolerance", o.tolerance, {0},
                        {"Exit with code 7 if the RMS error in L*u*v* of what one sees, alpha included, is "
                         "larger, or with --values that of a channel",
                         "none"}),
             comparison);
    in_group(add_flag(
                 app, "--values", [&o] { o.read.values = true; },
                 "The files hold data, not colours: compare the channels that both have, in their own unit"),
             comparison);
    in_group(add_choice(app, "--mode", o.mode, mode_choices(), {"How a container is drawn", "map"}),
             container);
    in_group(add_count(app, "--level", o.level, {0, std::numeric_limits<int>::max()},
                       {"Level of a container's pyramid, 0 the finest", "0"}),
             container);
    in_group(
        add_file(app, "--error-image", o.error_image,
                 "Image to write of the errors in L*u*v*, alpha included, from black for none over blue, "
                 "red and orange to white"),
        files);
    in_group(add_number(app, "--error-range", o.error_range, {0, kNoLimit, true},
                        {"Error that the error image shows as white", cat(kErrorRange)}),
             files);
    in_group(add_file(app, "--plot", o.plot, "Histograms to write (.svg, .png)"), files);
    add_read_options(app, o.read, nullptr, true);
    add_nodata_option(app, o.read);
    add_container_limits(app, o.limits);
}

bool is_pair(const Options& o) {
    return !o.reference.empty();
}

// What is read, in the order of the report.
std::vector<std::string> names_of(const Options& o) {
    return is_pair(o) ? std::vector{o.reference, o.input} : std::vector{o.input};
}

// Throws Error(kBadArgument) for mistakes that can be found before any file is read.
void check_options(const Options& o) {
    const auto refuse = [](const std::string& text) { throw Error(ErrorKind::kBadArgument, text); };
    const bool pair = is_pair(o);
    if (!pair && !is_container(o.input))
        refuse(cat(o.input, ": expected a second file, or a container (.glb, .gltf) alone"));
    const std::pair<const char*, bool> reading[] = {
        {"--color-space", o.read.color_space.has_value()},
        {"--part", o.read.part.has_value()},
        {"--layer", o.read.layer.has_value()},
        {"--non-finite", o.read.non_finite != NonFinite::kRefuse}};
    for (const auto& [name, given] : reading)
        if (given && !pair) refuse(cat(name, ": expected two files to compare"));
    for (const auto& [name, given] :
         {std::pair{"--mode", o.mode.has_value()}, std::pair{"--tolerance", o.tolerance.has_value()},
          std::pair{"--error-image", !o.error_image.empty()}})
        if (given && !pair) refuse(cat(name, ": expected two files to compare"));
    const std::vector<std::string> inputs = names_of(o);
    const bool containers = std::ranges::any_of(inputs, is_container);
    const bool pictures = !std::ranges::all_of(inputs, is_container);
    if ((o.mode || o.level) && !containers)
        refuse(cat(o.mode ? "--mode" : "--level", ": expected a container (.glb, .gltf) among the files"));
    for (const auto& [name, given] : reading)
        if (given && !pictures) refuse(cat(name, ": expected an image among the files"));
    if (o.read.values && !pair) refuse("--values: expected two files to compare");
    if (o.read.values && (o.read.color_space || !o.error_image.empty() || !o.plot.empty()))
        refuse("--values: values have neither a colour space nor an error image nor a plot");
    if (o.error_range && o.error_image.empty()) refuse("--error-range: expected --error-image as well");
    if (!o.error_image.empty() && !can_write_image(o.error_image))
        refuse(cat("--error-image ", o.error_image, ": expected the name of an image, as in .png"));
    const std::string plot = lower_extension(o.plot);
    if (!o.plot.empty() && plot != ".svg" && plot != ".png")
        refuse(cat("--plot ", o.plot, ": expected a name in .svg or .png"));
    const auto absolute = [](const std::string& path) { return fs::absolute(path).lexically_normal(); };
    if (!o.plot.empty() && !o.error_image.empty() && absolute(o.plot) == absolute(o.error_image))
        refuse(cat("--plot ", o.plot, ": is the error image as well"));
}

struct Input {
    std::vector<std::string> files;
    Image image;  // only if two files are compared
    std::optional<LevelQuality> quality;
    Report report;
};

Input load_picture(const std::string& path, const Options& o, Context& context) {
    ReadImageOptions options = image_options(o.read, o.limits, context.max_memory);
    options.limits.work_bytes = kPairBytes;
    ReadImage read = read_with_warnings(path, options, context.warnings);
    context.memory.take(cat(path, ": a comparison of ", read.image.width, "x", read.image.height, " pixels"),
                        kProgramMemory + static_cast<double>(read.image.pixel_count()) *
                                             (kChannelBytes * read.image.channels + kPairBytes));
    const Report facts = read_report(read);
    Input input{{path}, hidden_outside(read.image, read.data), {}, {}};
    if (!o.read.values && !has_color(input.image))
        throw Error(ErrorKind::kUnsupported,
                    cat(path, ": the image has no colour: neither channels R, G, B nor Y"));
    input.report = {{"input", path},
                    {"kind", "picture"},
                    {"width", input.image.width},
                    {"height", input.image.height},
                    {"color_space", color_space_name(input.image.color_space)}};
    input.report.update(facts);
    return input;
}

Input load_container(const std::string& path, const Options& o, Context& context) {
    const Container container = read_container(path, container_limits(o.limits, context.max_memory));
    const MeshImage& m = container.mesh_image;
    context.memory.take_for(path, m, kQualityBytes + (is_pair(o) ? kPairBytes : 0));
    const auto index = static_cast<std::size_t>(o.level.value_or(0));
    check_level("--level", o.level.value_or(0), path, m);
    const Level& level = m.levels[index];
    Input input;
    input.files = container.facts.files;
    input.report = {{"input", path},
                    {"kind", "container"},
                    {"width", m.source.width},
                    {"height", m.source.height},
                    {"color_space", color_space_name(m.source.color_space)},
                    {"level", index}};
    if (is_pair(o)) {
        const DrawMode mode = o.mode.value_or(DrawMode::kMap);
        if (!o.read.values && split_names(m.source.channel_names).color.empty())
            throw Error(ErrorKind::kUnsupported, cat(path, ": the container has no colour"));
        input.image = draw_channels(m, static_cast<int>(index), {mode});
        input.report["mode"] = name_of(mode_choices(), mode);
    }
    input.quality = LevelQuality{level.mesh.vertex_count(), level.mesh.faces.size(),
                                 mesh_distributions(level.mesh), map_distributions(level.mesh, level.map),
                                 map_quality(level.mesh, level.map, m.source.has_mask)};
    input.report.update(quality_report(*input.quality));
    return input;
}

void check_same_size(const Image& a, const Image& b, const std::vector<std::string>& names) {
    const auto size = [](const Image& image) { return cat(image.width, " x ", image.height); };
    if (size(a) != size(b))
        throw Error(ErrorKind::kBadFile, cat(names[0], " has ", size(a), " pixels, ", names[1], " has ",
                                             size(b), "; expected the same size"));
}

ImageDifference compare_inputs(const Input& a, const Input& b, const Options& o) {
    check_same_size(a.image, b.image, names_of(o));
    return compare_images(a.image, b.image);
}

// The difference of two files of values. Throws Error(kUnsupported) if no channel can be compared.
Report value_report(const Image& a, const Image& b, const std::vector<std::string>& names) {
    check_same_size(a, b, names);
    Report report = {{"pixels", 0}, {"in_one_only", 0}};
    for (const auto& [name, rms, max] : compare_channels(a, b))
        report["channels"][name] = {{"rms", rms}, {"max", max}};
    if (!report.contains("channels"))
        throw Error(ErrorKind::kUnsupported,
                    cat(names[0], " and ", names[1], ": have no channel of values in common, or no pixel"));
    const Mask in_a = alpha_mask(a, kVisible), in_b = alpha_mask(b, kVisible);
    std::int64_t both = 0, one = 0;
    for (std::size_t i = 0; i < a.pixel_count(); ++i) {
        both += in_a.contains(i) && in_b.contains(i) ? 1 : 0;
        one += in_a.contains(i) != in_b.contains(i) ? 1 : 0;
    }
    report["pixels"] = both;
    report["in_one_only"] = one;
    return report;
}

// panels: those of the errors of two files, or empty; the containers' measures are added.
Plot make_plot(const std::vector<Input>& inputs, const Options& o, std::vector<HistogramPanel> panels) {
    std::vector<std::string> names;
    std::vector<LevelQuality> qualities;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        if (!inputs[i].quality) continue;
        places.push_back(names.size());
        qualities.push_back(*inputs[i].quality);
        names.push_back(names_of(o)[i]);
    }
    for (HistogramPanel& panel : panels)
        for (HistogramSeries& series : panel.series) series.name = names.size();
    if (!panels.empty()) names.push_back(cat(o.reference, " against ", o.input));
    for (HistogramPanel& panel : quality_panels(qualities, places)) panels.push_back(std::move(panel));
    return histogram_plot(names, panels);
}

Image draw_plot(const Plot& plot, const std::string& path) {
    Image image = plot_boxes(plot, kPngScale);
    try {
        draw_text(image, plot_labels(plot, kPngScale));
    } catch (const Error& e) {
        throw Error(e.kind(), cat(path, ": ", e.what(), "; .svg needs no font"));
    }
    return image;
}

Report compare_one(const Options& o, Context& context) {
    for (const std::string& output : {o.error_image, o.plot})
        if (!output.empty()) check_output(output, context.overwrite);

    std::vector<Input> inputs;
    Report reports = Report::array();
    for (const std::string& path : names_of(o)) {
        context.progress(0.3 * static_cast<double>(inputs.size()), "read");
        inputs.push_back(is_container(path) ? load_container(path, o, context)
                                            : load_picture(path, o, context));
        check_distinct(inputs.back().files, {o.error_image, o.plot});
        reports.push_back(inputs.back().report);
    }
    Report report = {{"inputs", reports}};

    context.progress(0.6, "compare");
    std::vector<HistogramPanel> panels;
    std::optional<ImageDifference> difference;
    double difference_rms = 0;  // the one that --tolerance limits
    if (inputs.size() == 2 && o.read.values) {
        report["difference"] = value_report(inputs[0].image, inputs[1].image, names_of(o));
        for (const auto& [name, channel] : report["difference"]["channels"].items())
            difference_rms = std::max(difference_rms, channel["rms"].get<double>());
    } else if (inputs.size() == 2) {
        difference = compare_inputs(inputs[0], inputs[1], o);
        difference_rms = difference->rms_visible;
        const Distribution luv = distribution(difference->luv, kLuvErrorBins);
        const Distribution ciede2000 = distribution(difference->ciede2000, kCiede2000Bins);
        panels = {{"error in L*u*v*", {{0, luv}}}, {"CIEDE2000", {{0, ciede2000}}}};
        report["difference"] = difference_report(*difference, luv, ciede2000);
        for (const auto& [name, rms, max] : compare_channels(inputs[0].image, inputs[1].image))
            report["difference"]["channels"][name] = {{"rms", rms}, {"max", max}};
    }
    if (o.tolerance) {
        const bool within = difference_rms <= *o.tolerance;
        report["tolerance"] = *o.tolerance;
        report["within_tolerance"] = within;
        if (!within)
            context.failures.push_back(
                {ExitCode::kDifferent,
                 cat(o.reference, " and ", o.input, " differ: RMS ", format_number(difference_rms),
                     o.read.values ? " in the values' unit" : " in L*u*v*", ", more than --tolerance ",
                     *o.tolerance)});
    }

    context.progress(0.9, "write");
    // The plot is drawn before any file is written: without a font there are no outputs at all.
    const bool svg = lower_extension(o.plot) == ".svg";
    const Plot plot = o.plot.empty() ? Plot() : make_plot(inputs, o, std::move(panels));
    const Image plot_image = o.plot.empty() || svg ? Image() : draw_plot(plot, o.plot);
    JointFiles together;
    if (!o.error_image.empty()) {
        const double range = o.error_range.value_or(kErrorRange);
        write_image(o.error_image,
                    error_image(difference->visible, inputs[0].image.width, inputs[0].image.height, range),
                    {context.overwrite, {}});
        report["error_image"] = o.error_image;
        report["error_range"] = range;
    }
    if (!o.plot.empty()) {
        if (svg)
            write_text(o.plot, plot_svg(plot), context.overwrite);
        else
            write_image(o.plot, plot_image, {context.overwrite, {}});
        report["plot"] = o.plot;
    }
    together.commit();
    return report;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    return tool_main<Options>(
        {.name = "imgmesh-compare",
         .description = "Compare images and containers; tell the quality of a container's mesh and map.",
         .input_name = "INPUT",
         .input_help =
             "One container (.glb, .gltf), or files to compare: an image or container, and those that "
             "are compared with it",
         .compares = true,
         .instead_of_sets = "imgmesh-reconstruct draws it as a picture first"},
        {add_options,
         check_options,
         compare_one,
         print_comparison,
         comparison_line,
         {{"--error-image", "png", &Options::error_image}, {"--plot", "svg", &Options::plot}}},
        options, argc, argv);
}
