#include "tools/segment_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "libcore/image/color.h"

namespace imgmesh {
namespace {

std::string hex_color(const Vec3f& luv) {
    const Vec3f srgb = encoded_from_linear(ColorSpace::kSrgb, linear_from_luv(in_gamut(luv)));
    std::array<char, 8> text;
    const auto code = [&](Eigen::Index c) {
        return static_cast<unsigned>(std::lround(std::clamp(srgb[c], 0.0f, 1.0f) * 255));
    };
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", code(0), code(1), code(2));
    return text.data();
}

}  // namespace

std::vector<Vec3f> mean_colors(const std::vector<RegionFacts>& facts) {
    std::vector<Vec3f> colors;
    for (const RegionFacts& f : facts) colors.push_back(f.color);
    return colors;
}

Report segmentation_report(const Segmentation& result, const std::vector<RegionFacts>& facts) {
    const auto [least, most] =
        std::minmax_element(facts.begin(), facts.end(),
                            [](const RegionFacts& a, const RegionFacts& b) { return a.pixels < b.pixels; });
    const std::vector<Merge>& merges = result.hierarchy.merges;
    Report report = {{"width", result.labels.width},
                     {"height", result.labels.height},
                     {"cells", result.hierarchy.cells},
                     {"regions", result.labels.count},
                     {"min_pixels", least->pixels},
                     {"max_pixels", most->pixels},
                     {"merged_up_to", result.merges == 0 ? 0.0f : merges[result.merges - 1].height}};
    if (result.merges < merges.size()) report["next_merge"] = merges[result.merges].height;
    return report;
}

std::string regions_text(const LabelImage& labels, const std::vector<RegionFacts>& facts,
                         const std::string& generator, const std::string& input) {
    Report regions = Report::array();
    for (std::size_t id = 0; id < facts.size(); ++id) {
        const RegionFacts& f = facts[id];
        Report neighbors = Report::array();
        for (const auto& [other, length] : f.neighbors)
            neighbors.push_back({{"id", other}, {"border", length}});
        regions.push_back({{"id", id},
                           {"pixels", f.pixels},
                           {"box", f.box},
                           {"luv", {f.color[0], f.color[1], f.color[2]}},
                           {"srgb", hex_color(f.color)},
                           {"neighbors", std::move(neighbors)}});
    }
    const Report file = {{"$schema", "imgmesh-segment.regions.schema.json"},
                         {"generator", generator},
                         {"input", input},
                         {"width", labels.width},
                         {"height", labels.height},
                         {"regions", std::move(regions)}};
    return file.dump(1, ' ', false, Report::error_handler_t::replace) + "\n";
}

}  // namespace imgmesh
