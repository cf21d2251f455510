#include "tools/segment_options.h"

#include "formats/export/contour_files.h"
#include "formats/export/label_files.h"
#include "formats/files/extension.h"
#include "libcore/base/error.h"
#include "tools/common/choices.h"
#include "tools/common/help.h"
#include "tools/common/limits.h"
#include "tools/common/names.h"
#include "tools/common/options.h"
#include "tools/common/output.h"
#include "tools/common/read_options.h"
#include "tools/common/targets.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

// Far beyond, distances of merges would not be finite.
constexpr double kMostCompactness = 1e6;

void expect_extension(const std::string& option, const std::string& path, const std::string& extension) {
    if (!path.empty() && lower_extension(path) != extension)
        throw Error(ErrorKind::kBadArgument,
                    cat(option, " ", path, ": expected a name that ends with ", extension));
}

// Reads "X,Y", or several of them with a colon between: the corners of a line.
Seed parse_seed(const std::string& option, bool keep, const std::string& text) {
    Seed seed;
    seed.keep = keep;
    seed.where = cat(option, " ", text);
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(':', begin), text.size());
        const std::vector<std::string> numbers = split_list(text.substr(begin, end - begin));
        if (numbers.size() != 2)
            throw Error(
                ErrorKind::kBadArgument,
                cat(option, " '", shortened(text), "': expected X,Y, as in 250,260, or X,Y:X,Y for a line"));
        constexpr CountRange kPlace = {0, std::int64_t{1} << 31};
        seed.points.push_back(
            {parse_count(option, numbers[0], kPlace), parse_count(option, numbers[1], kPlace)});
        begin = end + 1;
    }
    return seed;
}

void add_seed_options(CLI::App& app, SegmentOptions& o) {
    const std::string group = "Choice of an object";
    for (const bool keep : {true, false}) {
        const std::string name = keep ? "--keep" : "--drop";
        in_group(add_values(
                     app, name, "X,Y",
                     [&o, name, keep](const std::string& text) {
                         o.seeds.push_back(parse_seed(name, keep, text));
                     },
                     keep ? "Pixel inside the object, or X,Y:X,Y for a line; may be given several times"
                          : "Pixel around the object, or a line; may be given several times"),
                 group);
    }
    in_group(add_file(app, "--mask", o.mask,
                      "Image to write of what --keep and --drop choose: white inside, black outside"),
             group);
}

}  // namespace

void add_segment_options(CLI::App& app, SegmentOptions& o) {
    const SegmentParams usual;
    const std::string regions = "Regions", files = "Files";
    in_group(add_number(app, "--threshold", o.threshold, {0, kNoLimit, true},
                        {"Merge across contours weaker than this; 4 leaves many regions, 10 few",
                         cat(usual.threshold)}),
             regions);
    in_group(add_value(
                 app, "--segments", "N",
                 [&o](const std::string& text) {
                     if (text == "auto")
                         o.params.clearest = true;
                     else
                         o.params.segments = parse_count("--segments", text, {1});
                 },
                 "Merge until this many regions are left; auto: near the default threshold, where regions "
                 "are clearest"),
             regions);
    in_group(add_count(app, "--superpixels", o.params.superpixels, {1},
                       "Make this many regions of similar size that follow edges"),
             regions);
    advanced(app, in_group(add_count(app, "--min-size", o.params.min_size, {1},
                                     "Least number of pixels of a region"),
                           regions));
    advanced(app, in_group(add_count(app, "--level", o.level, {0}, "Level of the pyramid, 0 the finest"),
                           regions));
    CLI::Option* const compactness =
        add_number(app, "--compactness", o.compactness, {0, kMostCompactness},
                   {"Compactness of superpixels; higher is rounder", cat(usual.compactness)});
    advanced(app, in_group(compactness, regions));
    CLI::Option* const distance =
        add_choice(app, "--distance", o.distance, distance_choices(),
                   {"Distance of regions, by their contours or by mean colours as in the paper",
                    name_of(distance_choices(), usual.distance)});
    advanced(app, in_group(distance, regions));
    CLI::Option* const quality =
        add_choice(app, "--quality", o.quality, segment_quality_choices(),
                   {"How carefully contours are measured: fast looks at colours in squares, default also at "
                    "texture, along smoothed outlines",
                    name_of(segment_quality_choices(), usual.quality)});
    advanced(app, in_group(quality, regions));
    add_seed_options(app, o);
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
    in_group(add_file(app, "--colors", o.colors,
                      "Image to write with each region in a colour of its own, unlike its neighbours'"),
             files);
    CLI::Option* const svg =
        in_group(add_file(app, "--svg", o.svg,
                          "Drawing to write with a shape for each region in its mean colour (.svg)"),
                 files);
    advanced(
        app,
        in_group(needs(add_number(app, "--svg-tolerance", o.svg_tolerance, {0, kMostOutlineTolerance},
                                  "How far shapes in --svg may leave the pixels' edges, in pixels; 0 draws "
                                  "every pixel's corner"),
                       svg),
                 files));
    advanced(app,
             in_group(add_file(app, "--report", o.report,
                               "List to write of each region's colour, pixels, box and neighbours (.json)"),
                      files));
    advanced(app, in_group(add_file(app, "--mesh", o.mesh,
                                    "Base mesh to write with one primitive for each region (.glb)"),
                           files));
    advanced(app, in_group(add_file(app, "--ucm", o.ucm,
                                    "Ultrametric contour map to write (.exr, .npy, or .mat with ucm2)"),
                           files));
}

SegmentParams params_of(const SegmentOptions& o) {
    SegmentParams params = o.params;
    params.threshold = o.threshold.value_or(params.threshold);
    params.compactness = o.compactness.value_or(params.compactness);
    params.distance = o.distance.value_or(params.distance);
    params.quality = o.quality.value_or(params.quality);
    return params;
}

std::vector<std::string> outputs_of(const SegmentOptions& o) {
    std::vector<std::string> outputs = {o.output};
    for (const std::string* path :
         {&o.outlines, &o.flat, &o.colors, &o.svg, &o.ucm, &o.report, &o.mesh, &o.mask})
        if (!path->empty()) outputs.push_back(*path);
    return outputs;
}

void check_segment_options(const SegmentOptions& o) {
    const bool segments = o.params.segments || o.params.clearest;
    if (o.threshold && segments)
        throw Error(ErrorKind::kBadArgument, "--threshold and --segments: expected one of them");
    if (o.params.superpixels && (o.threshold || segments || o.distance))
        throw Error(ErrorKind::kBadArgument, cat("--superpixels and ",
                                                 o.threshold ? "--threshold"
                                                 : segments  ? "--segments"
                                                             : "--distance",
                                                 ": expected one of them"));
    if (o.quality && (o.params.superpixels || o.distance == DistanceRule::kPaper))
        throw Error(ErrorKind::kBadArgument,
                    cat("--quality: means nothing with ",
                        o.params.superpixels ? "--superpixels" : "--distance paper"));
    if (o.compactness && !o.params.superpixels)
        throw Error(ErrorKind::kBadArgument, "--compactness: means something with --superpixels only");
    if (!can_write_labels(o.output))
        throw Error(ErrorKind::kBadArgument,
                    cat("-o ", o.output, ": expected a name that ends with .exr, .png, .tif, .npy or .mat"));
    if (!o.ucm.empty() && !can_write_contours(o.ucm))
        throw Error(ErrorKind::kBadArgument,
                    cat("--ucm ", o.ucm, ": expected a name that ends with .exr, .npy or .mat"));
    expect_extension("--svg", o.svg, ".svg");
    expect_extension("--report", o.report, ".json");
    expect_extension("--mesh", o.mesh, ".glb");
    for (const auto& [option, path] : {std::pair("--outlines", &o.outlines), std::pair("--flat", &o.flat),
                                       std::pair("--colors", &o.colors), std::pair("--mask", &o.mask)})
        if (!path->empty() && !can_write_image(*path))
            throw Error(ErrorKind::kBadArgument,
                        cat(option, " ", *path, ": expected the name of an image, as in .png"));
    if (o.seeds.empty() != o.mask.empty())
        throw Error(ErrorKind::kBadArgument,
                    o.mask.empty()
                        ? cat(o.seeds[0].where, ": means something with --mask only")
                        : cat("--mask ", o.mask, ": expected --keep or --drop, which say what is inside"));
    check_separate(outputs_of(o));
}

}  // namespace imgmesh
