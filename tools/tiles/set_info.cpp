#include "tools/tiles/set_info.h"

#include <nlohmann/json.hpp>
#include <ostream>

#include "formats/tileset/tile_set_files.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

Report level_report(const TileSetIndex& index, int level) {
    const TileTotals t = level_totals(index, level);
    const TileGrid grid = index.plan.grid();
    Report report = {{"columns", grid.columns(level)}, {"rows", grid.rows(level)}, {"tiles", t.tiles},
                     {"vertices", t.own_vertices},     {"faces", t.faces},         {"bytes", t.bytes}};
    if (level == 0)
        report.update({{"pixels", t.pixels},
                       {"map_rms", t.map_rms},
                       {"gouraud_rms", t.gouraud_rms},
                       {"seam_rms", t.seam_rms}});
    return report;
}

}  // namespace

Report set_facts(const std::string& path) {
    const TileSetIndex index = read_index(tile_set_folder(path));
    const TileSetPlan& plan = index.plan;
    Report levels = Report::array(), missing = Report::array(), build = Report::object();
    for (int level = 0; level < plan.grid().levels(); ++level) levels.push_back(level_report(index, level));
    for (const MissingTile& tile : index.missing)
        missing.push_back({{"tile", tile_text(tile.tile)}, {"reason", tile.reason}});
    for (const auto& [name, value] : plan.parameters) build[name] = value;
    return {{"built_by", plan.generator},
            {"source", plan.source.path},
            {"width", plan.width},
            {"height", plan.height},
            {"tile", plan.tile},
            {"density", plan.density},
            {"threshold", index.threshold},
            {"key", plan_key(plan)},
            {"levels", levels},
            {"missing", missing},
            {"build", build}};
}

void print_set_facts(const Report& report, std::ostream& out) {
    const auto number = [](const Report& value) { return format_number(value.get<double>()); };
    out << printable_line(report["input"].get<std::string>()) << '\n';
    TextTable table;
    table.add("size", cat(report["width"], " x ", report["height"], " pixels, tiles of ", report["tile"]));
    table.add("source", printable_line(report["source"].get<std::string>()));
    table.add("built by", printable_line(report["built_by"].get<std::string>()));
    table.add("threshold", number(report["threshold"]));
    for (const auto& [name, value] : report["build"].items())
        table.add("  " + printable_line(name), printable_line(value.get<std::string>()));
    for (std::size_t k = 0; k < report["levels"].size(); ++k) {
        const Report& level = report["levels"][k];
        std::string text =
            cat(level["columns"], " x ", level["rows"], " tiles, ", level["vertices"], " vertices, ",
                level["faces"], " faces, ", format_bytes(level["bytes"].get<std::uint64_t>()));
        if (level.contains("map_rms"))
            text += cat(", RMS ", number(level["map_rms"]), ", at seams ", number(level["seam_rms"]));
        table.add(cat("level ", k), text);
    }
    for (const Report& tile : report["missing"])
        table.add("missing",
                  printable_line(tile["tile"].get<std::string>() + ": " + tile["reason"].get<std::string>()));
    table.print(out, 2);
}

std::string set_facts_line(const Report& report) {
    const Report& finest = report["levels"][0];
    std::string text = cat(report["width"], " x ", report["height"], " pixels, ", finest["tiles"], " tiles, ",
                           finest["vertices"], " vertices, ", finest["faces"], " faces");
    if (!report["missing"].empty()) text += cat(", missing ", report["missing"].size());
    return text;
}

}  // namespace imgmesh
