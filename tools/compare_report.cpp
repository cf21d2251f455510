#include "tools/compare_report.h"

#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <ostream>

#include "libcore/image/color.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

// A measure: its name in the report, and its title in text and plots.
template <typename Distributions>
struct Measure {
    const char* key;
    const char* title;
    Distribution Distributions::*distribution;
};

constexpr Measure<MeshDistributions> kMeshMeasures[] = {
    {"valence", "valence", &MeshDistributions::valence},
    {"edge_ratio", "edge ratio", &MeshDistributions::edge_ratio},
    {"aspect_ratio", "aspect ratio", &MeshDistributions::aspect_ratio},
    {"radius_ratio", "radius ratio", &MeshDistributions::radius_ratio},
    {"radius_edge_ratio", "circumradius / shortest edge", &MeshDistributions::radius_edge_ratio},
    {"min_angle_deg", "smallest angle [degrees]", &MeshDistributions::min_angle_deg},
    {"shape", "shape q", &MeshDistributions::shape},
};
constexpr Measure<MapDistributions> kMapMeasures[] = {
    {"jump", "jump of neighbours [px]", &MapDistributions::jump},
    {"displacement", "displacement [px]", &MapDistributions::displacement},
    {"patch_per_area", "pixels of patch / area of face", &MapDistributions::patch_per_area},
};

template <typename Distributions>
void add_panels(std::vector<HistogramPanel>& panels, const Measure<Distributions>& measure,
                const Distributions LevelQuality::*part, const std::vector<LevelQuality>& qualities,
                const std::vector<std::size_t>& names) {
    HistogramPanel panel{measure.title, {}};
    for (std::size_t i = 0; i < qualities.size(); ++i)
        panel.series.push_back({names[i], qualities[i].*part.*measure.distribution});
    panels.push_back(std::move(panel));
}

// Until the report is printed as JSON, infinite and undefined numbers are not null yet.
std::string number(const Report& value) {
    const double x = value.get<double>();
    return std::isfinite(x) ? format_number(x) : "-";
}

void print_distribution_row(const std::string& title, const Report& d, std::ostream& out) {
    out << "    " << std::left << std::setw(30) << title << std::right;
    for (const char* key : {"mean", "min", "p5", "median", "p95", "max"})
        out << std::setw(10) << number(d[key]);
    out << '\n';
}

void print_quality(const Report& input, std::ostream& out) {
    out << printable_line(input["input"].get<std::string>()) << ": level " << input["level"] << ", "
        << input["vertices"] << " vertices, " << input["faces"] << " faces\n    " << std::setw(30) << ""
        << std::right;
    for (const char* title : {"mean", "least", "5 %", "median", "95 %", "largest"})
        out << std::setw(10) << title;
    out << '\n';
    for (const auto& m : kMeshMeasures) print_distribution_row(m.title, input["mesh"][m.key], out);
    for (const auto& m : kMapMeasures) print_distribution_row(m.title, input["map"][m.key], out);
    TextTable table;
    table.add("folds", cat(input["map"]["flipped_triangles"], " pixel triangles"));
    table.add("empty", cat(input["map"]["empty_patches"], " faces without pixels"));
    table.print(out, 4);
}

void print_channels(const Report& d, TextTable& table) {
    if (!d.contains("channels")) return;
    for (const auto& [name, channel] : d["channels"].items())
        table.add(printable_line(name),
                  cat("RMS ", number(channel["rms"]), ", largest ", number(channel["max"])));
}

void print_difference(const Report& d, std::ostream& out) {
    TextTable table;
    std::string pixels = cat(d["pixels"]);
    if (d["in_one_only"] != 0) pixels += cat("; ", d["in_one_only"], " are transparent in one of the two");
    table.add("pixels", pixels);
    if (!d.contains("rms_luv")) {
        print_channels(d, table);
        table.print(out, 4);
        return;
    }
    table.add("L*u*v*", cat("RMS ", number(d["rms_luv"]), ", largest ", number(d["max_luv"])));
    if (d["max_alpha"] != 0) {
        table.add("alpha",
                  cat("RMS ", number(d["rms_alpha"]), ", largest ", number(d["max_alpha"]), " of 1"));
    }
    if (d["rms_visible"] != d["rms_luv"]) {
        table.add("visible", cat("RMS ", number(d["rms_visible"]), ", largest ", number(d["max_visible"]),
                                 " in L*u*v* over black or white"));
    }
    table.add("RGB", cat("RMS ", number(d["rms_rgb"]), ", largest ", number(d["max_rgb"]), " of 1, in ",
                         d["color_space"].get<std::string>()));
    table.add("PSNR",
              std::isinf(d["psnr"].get<double>()) ? "infinite: equal" : cat(number(d["psnr"]), " dB"));
    table.add("SSIM", std::isnan(d["ssim"].get<double>()) ? "-, no window of 11 x 11 pixels fits"
                                                          : number(d["ssim"]));
    const Report& e = d["ciede2000"];
    table.add("CIEDE2000",
              cat("mean ", number(e["mean"]), ", 95 % ", number(e["p95"]), ", largest ", number(e["max"])));
    print_channels(d, table);
    table.print(out, 4);
}

}  // namespace

Report distribution_report(const Distribution& d) {
    return {{"count", d.count},
            {"mean", d.mean},
            {"deviation", d.deviation},
            {"min", d.min},
            {"p5", d.p5},
            {"p25", d.p25},
            {"median", d.median},
            {"p75", d.p75},
            {"p95", d.p95},
            {"max", d.max},
            {"histogram",
             {{"low", d.bins.low},
              {"high", d.bins.high},
              {"counts", d.histogram},
              {"below", d.below},
              {"above", d.above}}}};
}

Report quality_report(const LevelQuality& quality) {
    Report mesh = Report::object();
    for (const auto& m : kMeshMeasures) mesh[m.key] = distribution_report(quality.mesh.*m.distribution);
    Report map = {{"flipped_triangles", quality.map_quality.flipped_triangles},
                  {"empty_patches", quality.map.empty_patches}};
    for (const auto& m : kMapMeasures) map[m.key] = distribution_report(quality.map.*m.distribution);
    return {{"vertices", quality.vertices}, {"faces", quality.faces}, {"mesh", mesh}, {"map", map}};
}

Report difference_report(const ImageDifference& difference, const Distribution& luv,
                         const Distribution& ciede2000) {
    return {{"pixels", difference.pixels},
            {"in_one_only", difference.in_one_only},
            {"color_space", color_space_name(difference.color_space)},
            {"rms_luv", difference.rms_luv},
            {"max_luv", difference.max_luv},
            {"rms_visible", difference.rms_visible},
            {"max_visible", difference.max_visible},
            {"rms_alpha", difference.rms_alpha},
            {"max_alpha", difference.max_alpha},
            {"rms_rgb", difference.rms_rgb},
            {"max_rgb", difference.max_rgb},
            {"psnr", difference.psnr},
            {"ssim", difference.ssim},
            {"luv", distribution_report(luv)},
            {"ciede2000", distribution_report(ciede2000)}};
}

std::vector<HistogramPanel> quality_panels(const std::vector<LevelQuality>& qualities,
                                           const std::vector<std::size_t>& names) {
    std::vector<HistogramPanel> panels;
    if (qualities.empty()) return panels;
    for (const auto& m : kMeshMeasures) add_panels(panels, m, &LevelQuality::mesh, qualities, names);
    for (const auto& m : kMapMeasures) add_panels(panels, m, &LevelQuality::map, qualities, names);
    return panels;
}

void print_comparison(const Report& report, std::ostream& out) {
    if (report.contains("difference")) {
        const auto name = [&](std::size_t i) { return report["inputs"][i]["input"].get<std::string>(); };
        out << printable_line(name(0) + " against " + name(1)) << '\n';
        print_difference(report["difference"], out);
    }
    for (const Report& input : report["inputs"])
        if (input["kind"] == "container") print_quality(input, out);
    for (const char* output : {"error_image", "plot"})
        if (report.contains(output)) out << printable_line("-> " + report[output].get<std::string>()) << '\n';
}

std::string comparison_line(const Report& report) {
    if (!report.contains("difference")) return cat(report["inputs"][0]["faces"], " faces");
    const Report& d = report["difference"];
    if (d.contains("rms_visible"))
        return cat("RMS ", number(d["rms_visible"]), " in L*u*v*, PSNR ",
                   std::isinf(d["psnr"].get<double>()) ? "infinite" : cat(number(d["psnr"]), " dB"));
    std::string text;
    for (const auto& [name, channel] : d["channels"].items())
        text += cat(text.empty() ? "" : ", ", name, " RMS ", number(channel["rms"]));
    return text;
}

}  // namespace imgmesh
