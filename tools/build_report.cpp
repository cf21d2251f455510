#include "tools/build_report.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>

#include "libcore/image/color.h"
#include "libcore/image/feature_space.h"
#include "libcore/metrics/metrics.h"
#include "tools/common/text.h"

namespace imgmesh {

Report image_report(const Image& image, const std::string& alpha, bool values, const BuildReport& built,
                    const Container& written, const FileSeconds& seconds) {
    const bool has_map = written.facts.layer_bytes > 0;
    Report levels = Report::array();
    const std::vector<std::string> auxiliary = split_names(written.mesh_image.source.channel_names).auxiliary;
    for (std::size_t k = 0; k < written.mesh_image.levels.size(); ++k) {
        const Level& level = written.mesh_image.levels[k];
        levels.push_back({{"vertices", level.mesh.vertex_count()},
                          {"faces", level.mesh.faces.size()},
                          {"error", level.error},
                          {"gouraud_rms", built.levels[k].gouraud_rms},
                          {"mean_edge_ratio", mesh_quality(level.mesh).mean_edge_ratio}});
        if (has_map) {
            levels.back()["map_rms"] = built.levels[k].map_rms;
            levels.back()["flipped_pixel_triangles"] = map_quality(level.mesh, level.map).flipped_triangles;
        }
        const LevelReport& figures = built.levels[k];
        if (figures.position_step > double{kPositionStep}) {
            levels.back()["position_step"] = figures.position_step;
            levels.back()["fine_vertices"] = figures.fine_vertices;
        }
        if (figures.color_levels > 0) levels.back()["color_levels"] = figures.color_levels;
        for (std::size_t c = 0; c < auxiliary.size(); ++c)
            levels.back()["channel_rms"][auxiliary[c]] = built.levels[k].auxiliary_rms[c];
    }
    const double bytes = static_cast<double>(written.facts.total_bytes);
    Report report{{"width", image.width},
                  {"height", image.height},
                  {"color_space", color_space_name(image.color_space)},
                  {"has_light", written.mesh_image.source.gamut == Gamut::kHdr},
                  {"alpha", alpha},
                  {"pixels", built.pixels},
                  {"values", values},
                  {"clipped_samples", built.clipped_samples}};
    report.update(levels.front());  // the finest level's figures are the image's
    report.update({{"levels", levels},
                   {"bytes", written.facts.total_bytes},
                   {"mesh_bytes", written.facts.mesh_bytes},
                   {"layer_bytes", written.facts.layer_bytes},
                   {"texture_bytes", written.facts.texture_bytes},
                   {"bytes_per_pixel", bytes / static_cast<double>(image.pixel_count())},
                   {"seconds", seconds.all},
                   {"stage_seconds",
                    {{"read", seconds.read},
                     {"collapse", built.seconds.collapse},
                     {"refine", built.seconds.refine},
                     {"map", built.seconds.map},
                     {"write", seconds.write}}}});
    return report;
}

void print_build(const Report& image, std::ostream& out) {
    out << printable_line(image["input"].get<std::string>() + " -> " + image["output"].get<std::string>())
        << '\n';
    const auto number = [&](const char* key) { return format_number(image[key].get<double>()); };
    TextTable table;
    table.add("size", cat(image["width"], " x ", image["height"], " pixels"));
    if (image.contains("layer")) {
        const std::string part = printable_line(image["part"].get<std::string>()),
                          layer = printable_line(image["layer"].get<std::string>());
        table.add("read", cat("part ", part, layer.empty() ? ", unnamed layer" : ", layer ", layer));
    }
    if (image["alpha"] != "none") table.add("alpha", image["alpha"].get<std::string>());
    if (image["pixels"] != image["width"].get<std::int64_t>() * image["height"].get<std::int64_t>())
        table.add("masked image", cat(image["pixels"], " pixels"));
    table.add("mesh", cat(image["vertices"], " vertices, ", image["faces"], " faces"));
    if (image.contains("position_step") || image.contains("color_levels")) {
        std::string text;
        if (image.contains("position_step")) {
            const auto step = image["position_step"].get<double>();
            text = cat("positions on ", step == 1 ? "" : "1/", std::lround(1 / step), " pixel");
            if (const auto fine = image["fine_vertices"].get<std::size_t>(); fine > 0)
                text += cat(" but for ", fine, fine == 1 ? " vertex" : " vertices");
        }
        if (image.contains("color_levels"))
            text += cat(text.empty() ? "" : ", ", image["color_levels"], " levels of R, G and B");
        table.add("precision", text);
    }
    const bool has_map = image.contains("map_rms");
    table.add("error",
              cat(has_map ? cat("map ", number("map_rms"), ", ") : "", "Gouraud ", number("gouraud_rms"),
                  image["values"] ? " RMS in the values' unit" : " L*u*v* RMS"));
    if (image.contains("channel_rms"))
        for (const auto& [name, rms] : image["channel_rms"].items())
            table.add(printable_line(name),
                      cat(has_map ? "map " : "", format_number(rms.get<double>()), " RMS"));
    for (std::size_t k = 1; k < image["levels"].size(); ++k) {
        const Report& level = image["levels"][k];
        table.add(cat("level ", k),
                  cat(level["vertices"], " vertices, ", level["faces"], " faces, ",
                      has_map ? cat("map ", format_number(level["map_rms"].get<double>()), ", ") : "",
                      "Gouraud ", format_number(level["gouraud_rms"].get<double>())));
    }
    table.add("edge ratio", number("mean_edge_ratio"));
    if (has_map)
        table.add("folds", cat(image["flipped_pixel_triangles"], " pixel triangles"));
    else
        table.add("pixel map", "none");
    table.add("file", cat(format_bytes(image["bytes"].get<std::uint64_t>()), ", ", number("bytes_per_pixel"),
                          " bytes per pixel"));
    table.add("time", cat(number("seconds"), " s"));
    table.print(out, 2);
}

std::string build_line(const Report& image) {
    return cat(image["width"], " x ", image["height"], " pixels, ", image["vertices"], " vertices, ",
               image["faces"], " faces, ", format_bytes(image["bytes"].get<std::uint64_t>()), ", ",
               format_number(image["seconds"].get<double>()), " s");
}

}  // namespace imgmesh
