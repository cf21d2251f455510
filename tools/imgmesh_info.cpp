// imgmesh-info: facts about a container or a tile set, and whether it is sound. Does not link OpenImageIO.
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>

#include "formats/container/container.h"
#include "formats/container/validate.h"
#include "formats/tileset/tile_set_files.h"
#include "formats/tileset/validate_set.h"
#include "libcore/image/color.h"
#include "libcore/metrics/metrics.h"
#include "tools/common/limits.h"
#include "tools/common/memory.h"
#include "tools/common/names.h"
#include "tools/common/options.h"
#include "tools/common/text.h"
#include "tools/common/tool_main.h"
#include "tools/tiles/set_info.h"

using namespace imgmesh;

namespace {

// Reading and measuring take this, beside the container itself [bytes a pixel]; measured as in
// docs/limits.md.
constexpr double kInfoBytes = 8;

struct Options {
    std::string input, output;
    bool validate = false;
    bool warnings_as_errors = false;
    ContainerLimits limits;
};

void add_options(CLI::App& app, Options& o) {
    const std::string validation = "Validation";
    CLI::Option* const validate =
        in_group(add_flag(
                     app, "--validate", [&o] { o.validate = true; },
                     "Only tell whether the container or tile set is sound, with every finding"),
                 validation);
    in_group(needs(add_flag(
                       app, "--warnings-as-errors", [&o] { o.warnings_as_errors = true; },
                       "Warnings make the container fail, too"),
                   validate),
             validation);
    add_container_limits(app, o.limits);
}

Report mesh_report(const MeshQuality& q) {
    return {{"edges", q.edges},
            {"boundary_edges", q.boundary_edges},
            {"components", q.components},
            {"euler", q.euler},
            {"nonmanifold_edges", q.nonmanifold_edges},
            {"nonmanifold_vertices", q.nonmanifold_vertices},
            {"flipped_faces", q.flipped_faces},
            {"area", q.area},
            {"mean_valence", q.mean_valence},
            {"mean_edge_ratio", q.mean_edge_ratio},
            {"mean_radius_ratio", q.mean_radius_ratio},
            {"mean_shape", q.mean_shape},
            {"min_shape", q.min_shape},
            {"min_angle_deg", q.min_angle_deg}};
}

Report map_report(const MapQuality& q, WeightPrecision precision) {
    return {{"precision", name_of(bary_choices(), precision)},
            {"pixels", q.pixels},
            {"unmapped", q.unmapped},
            {"outside_simplex", q.outside_simplex},
            {"flipped_triangles", q.flipped_triangles},
            {"min_area2", q.min_area2},
            {"max_jump", q.max_jump},
            {"mean_displacement", q.mean_displacement},
            {"max_displacement", q.max_displacement}};
}

Report facts_report(const Container& container) {
    const MeshImage& m = container.mesh_image;
    const ContainerFacts& facts = container.facts;
    Report levels = Report::array();
    for (const Level& level : m.levels) {
        levels.push_back({{"vertices", level.mesh.vertex_count()},
                          {"faces", level.mesh.faces.size()},
                          {"error", level.error},
                          {"mesh", mesh_report(mesh_quality(level.mesh))},
                          {"map", map_report(map_quality(level.mesh, level.map, m.source.has_mask),
                                             level.map.precision)}});
    }
    Report build = Report::object();
    for (const auto& [name, value] : m.parameters)
        std::visit([&member = build[name]](const auto& v) { member = v; }, value);
    return {{"version", facts.version},
            {"built_by", m.generator},
            {"width", m.source.width},
            {"height", m.source.height},
            {"channels", m.source.channel_names},
            {"color_space", color_space_name(m.source.color_space)},
            {"sample_type", name_of(sample_type_choices(), m.source.sample_type)},
            {"has_light", m.source.gamut == Gamut::kHdr},
            {"has_mask", m.source.has_mask},
            {"has_visits", !m.visits.empty()},
            {"draco", name_of(draco_choices(), facts.draco)},
            {"layers", name_of(layer_choices(), facts.layout)},
            {"bytes",
             {{"total", facts.total_bytes},
              {"meshes", facts.mesh_bytes},
              {"layers", facts.layer_bytes},
              {"texture", facts.texture_bytes},
              {"other", facts.total_bytes - facts.mesh_bytes - facts.layer_bytes - facts.texture_bytes}}},
            {"levels", levels},
            {"build", build}};
}

std::string severity_name(Severity severity) {
    return severity == Severity::kError ? "error" : severity == Severity::kWarning ? "warning" : "info";
}

Report place_report(const Place& place) {
    Report report = Report::object();
    if (!place.pointer.empty()) report["pointer"] = place.pointer;
    if (!place.part.empty()) report["part"] = place.part;
    if (!place.channel.empty()) report["channel"] = place.channel;
    if (place.pixel) report["pixel"] = {place.pixel->first, place.pixel->second};
    if (place.byte) report.update({{"byte", *place.byte}, {"bytes_of", place.bytes_of}});
    return report;
}

// Returns the verdict. The first finding that counts as an error becomes the run's failure, with the text of
// a reader's error.
Report validate(const Options& o, Context& context) {
    std::map<Severity, std::uint64_t> counts;
    Report findings = Report::array();
    const ContainerLimits limits = container_limits(o.limits, context.max_memory);
    for (const Issue& issue : is_tile_set(o.input)
                                  ? validate_tile_set(tile_set_folder(o.input), limits, context.progress)
                                  : validate_container(o.input, limits)) {
        const Finding& finding = *issue.finding;
        ++counts[finding.severity];
        const bool fails = finding.severity == Severity::kError ||
                           (o.warnings_as_errors && finding.severity == Severity::kWarning);
        if (fails && context.failures.empty())
            context.failures.push_back(
                {exit_code(finding.error), cat(o.input, ": [", finding.code, "] ", issue.text)});
        findings.push_back({{"code", finding.code},
                            {"severity", severity_name(finding.severity)},
                            {"message", issue.text},
                            {"place", place_report(issue.place)},
                            {"count", issue.count}});
    }
    return {{"valid", context.failures.empty()},
            {"errors", counts[Severity::kError]},
            {"warnings", counts[Severity::kWarning]},
            {"infos", counts[Severity::kInfo]},
            {"findings", findings}};
}

Report tell_one(const Options& o, Context& context) {
    Report report = {{"input", o.input}};
    if (o.validate) {
        report.update(validate(o, context));
        return report;
    }
    if (is_tile_set(o.input)) {
        report.update(set_facts(o.input));
        return report;
    }
    const Container container = read_container(o.input, container_limits(o.limits, context.max_memory));
    context.memory.take_for(o.input, container.mesh_image, kInfoBytes);
    report.update(facts_report(container));
    return report;
}

std::string place_line(const Report& place) {
    std::string text;
    const auto append = [&](const std::string& item) { text += (text.empty() ? "" : ", ") + item; };
    for (const char* name : {"pointer", "part", "channel"})
        if (place.contains(name))
            append((name == std::string("pointer") ? "" : cat(name, " ")) + place[name].get<std::string>());
    if (place.contains("pixel")) append(cat("pixel ", place["pixel"][0], ",", place["pixel"][1]));
    if (place.contains("byte"))
        append(cat("byte ", place["byte"], " of the ", place["bytes_of"].get<std::string>()));
    return text;
}

void print_verdict(const Report& report, std::ostream& out) {
    out << printable_line(report["input"].get<std::string>()) << ": "
        << (report["valid"] ? "valid" : "not valid");
    if (!report["findings"].empty())
        out << "; errors " << report["errors"] << ", warnings " << report["warnings"] << ", infos "
            << report["infos"];
    out << '\n';
    for (const Report& f : report["findings"]) {
        const std::string place = place_line(f["place"]);
        std::string line = cat(f["severity"].get<std::string>(), " ", f["code"].get<std::string>(), ": ",
                               f["message"].get<std::string>());
        if (!place.empty()) line += cat(" [", place, "]");
        if (f["count"] > 1) line += cat(" (", f["count"], " in all)");
        out << "  " << printable_line(line) << '\n';
    }
}

void print_level(const Report& level, std::ostream& out) {
    const Report& mesh = level["mesh"];
    const Report& map = level["map"];
    const auto number = [](const Report& value) { return format_number(value.get<double>()); };
    TextTable table;
    table.add("mesh", cat(level["vertices"], " vertices, ", level["faces"], " faces, error ",
                          number(level["error"])));
    table.add("topology", cat("Euler ", mesh["euler"], ", components ", mesh["components"], ", non-manifold ",
                              mesh["nonmanifold_edges"], " edges and ", mesh["nonmanifold_vertices"],
                              " vertices, flipped faces ", mesh["flipped_faces"]));
    table.add("triangles", cat("edge ratio ", number(mesh["mean_edge_ratio"]), ", shape ",
                               number(mesh["mean_shape"]), ", least ", number(mesh["min_shape"]),
                               ", least angle ", number(mesh["min_angle_deg"]), " degrees"));
    table.add("map",
              cat(map["precision"].get<std::string>(), ", ", map["pixels"], " pixels, folds ",
                  map["flipped_triangles"], " pixel triangles, moves ", number(map["mean_displacement"]),
                  " pixels, at most ", number(map["max_displacement"])));
    table.print(out, 4);
}

void print(const Report& report, std::ostream& out) {
    if (report.contains("valid")) {
        print_verdict(report, out);
        return;
    }
    if (report.contains("tile")) {
        print_set_facts(report, out);
        return;
    }
    const std::string input = printable_line(report["input"].get<std::string>());
    const auto text = [&](const char* key) { return report[key].get<std::string>(); };
    const auto bytes = [&](const char* part) {
        return format_bytes(report["bytes"][part].get<std::uint64_t>());
    };
    std::string channels;
    for (const Report& name : report["channels"])
        channels += (channels.empty() ? "" : " ") + name.get<std::string>();

    out << input << '\n';
    TextTable table;
    table.add("size", cat(report["width"], " x ", report["height"], " pixels"));
    table.add("channels", cat(channels, ", ", text("sample_type"), ", ", text("color_space"),
                              report["has_light"] ? ", HDR" : "", report["has_mask"] ? ", with a mask" : ""));
    table.add("container",
              cat("version ", text("version"), ", Draco ", text("draco"), ", layers ", text("layers")));
    table.add("file", cat(bytes("total"), ": meshes ", bytes("meshes"), ", layers ", bytes("layers"),
                          ", other ", bytes("other")));
    if (report["bytes"]["texture"] > 0) table.add("texture", bytes("texture"));
    table.add("built by", text("built_by"));
    for (const auto& [name, value] : report["build"].items()) table.add("  " + name, value.dump());
    table.print(out, 2);
    for (std::size_t i = 0; i < report["levels"].size(); ++i) {
        out << "  level " << i << '\n';
        print_level(report["levels"][i], out);
    }
}

std::string line(const Report& report) {
    if (report.contains("valid")) {
        std::string text = report["valid"] ? "valid" : "not valid";
        for (const char* kind : {"errors", "warnings"})
            if (report[kind] != 0) text += cat(", ", kind, ' ', report[kind]);
        return text;
    }
    if (report.contains("tile")) return set_facts_line(report);
    const Report& finest = report["levels"][0];
    return cat(report["width"], " x ", report["height"], " pixels, levels ", report["levels"].size(), ", ",
               finest["vertices"], " vertices, ", finest["faces"], " faces, ",
               format_bytes(report["bytes"]["total"].get<std::uint64_t>()));
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    return tool_main<Options>(
        {.name = "imgmesh-info",
         .description = "Tell what is in containers and tile sets, and whether they are sound.",
         .input_name = "CONTAINER",
         .input_help = "Containers to read (.glb, .gltf), or folders of tile sets"},
        {add_options, nullptr, tell_one, print, line}, options, argc, argv);
}
