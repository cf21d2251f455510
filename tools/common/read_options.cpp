#include "tools/common/read_options.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "libcore/base/error.h"
#include "tools/common/help.h"
#include "tools/common/names.h"
#include "tools/common/options.h"

namespace imgmesh {

void add_read_options(CLI::App& app, ReadImageOptions& options, CLI::Option* image, bool has_limits) {
    const auto add = [&](CLI::Option* option) {
        if (image) needs(option, image);
        return in_group(option, "Image");
    };
    const auto name = [&](const char* option, std::optional<std::string>& target, const Help& help) {
        return add(add_value(
            app, option, "NAME", [&target](const std::string& text) { target = text; }, help));
    };
    advanced(app, add(add_choice(app, "--color-space", options.color_space, color_space_choices(),
                                 {"Colour space of the images, whatever their files say", ""})));
    advanced(app, name("--part", options.part,
                       {"Part of an EXR, by its name or its number from 0", "the first with colour"}));
    name("--layer", options.layer,
         {"Layer of an EXR: all before the last dot of its channels' names, as in ViewLayer.Combined",
          "the unnamed one if it has colour, else the first that has"});
    advanced(app, add(add_choice(app, "--non-finite", options.non_finite, non_finite_choices(),
                                 "What becomes of infinite samples and of those that are no numbers")));
    if (has_limits) return;
    const auto take_pixels = [&options](const std::string& text) {
        options.limits.max_pixels = parse_count("--max-pixels", text, {1});
        options.limits.max_pixels_per_byte = 0;  // images up to there are wanted, however few bytes hold them
    };
    CLI::Option* const pixels = add_value(
        app, "--max-pixels", "N", take_pixels,
        {"Refuse an image of more pixels", cat(options.limits.max_pixels, ", and for a file of few bytes ",
                                               options.limits.max_pixels_per_byte, " a byte above 4194304")});
    if (image) needs(pixels, image);
    advanced(app, in_group(pixels, kLimitsGroup));
}

ReadImage read_with_warnings(const std::string& path, const ReadImageOptions& options,
                             std::vector<std::string>& warnings) {
    constexpr std::size_t kMostWarnings = 10;  // of one file; a damaged one can give hundreds
    ReadImage read = read_image_file(path, options);
    std::vector<std::string>& found = read.warnings;
    const std::size_t told = found.size() > kMostWarnings ? kMostWarnings - 1 : found.size();
    for (std::size_t i = 0; i < told; ++i) warnings.push_back(cat(path, ": ", found[i]));
    if (told < found.size()) warnings.push_back(cat(path, ": and ", found.size() - told, " more warnings"));
    found.clear();
    return read;
}

Report read_report(const ReadImage& read) {
    Report report = Report::object();
    if (read.place) report = {{"part", read.place->part}, {"layer", read.place->layer}};
    if (read.non_finite > 0) report["non_finite"] = read.non_finite;
    return report;
}

void add_nodata_option(CLI::App& app, ReadImageOptions& options) {
    const auto take = [&options](const std::string& text) {
        options.file_nodata = false;
        options.nodata.reset();
        if (text == "none") return;
        options.nodata = text == "nan" ? std::numeric_limits<double>::quiet_NaN()
                                       : parse_number("--nodata", text, {-kNoLimit, kNoLimit});
    };
    CLI::Option* const option = add_value(
        app, "--nodata", "X", take,
        {"Value of the pixels that are no data, in the file's own numbers, or nan: they lie outside "
         "the mask where all channels but alpha have it; none ignores the value that a TIFF names",
         "what a TIFF names (GDAL)"});
    advanced(app, in_group(option, "Image"));
}

}  // namespace imgmesh
