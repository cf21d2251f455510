#include "formats/container/edit_file.h"

#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "formats/files/atomic_file.h"
#include "formats/files/image_signature.h"
#include "formats/findings/json_node.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using nlohmann::json;

// Far outside any image, and far below the numbers that lose their fractions.
constexpr double kFarthest = 1e6;
constexpr double kSmallestScale = 1e-3, kLargestScale = 1e3;

double coordinate(const JsonNode& node) {
    return node.number(-kFarthest, kFarthest);
}

Vec2d point(const JsonNode& node) {
    const std::vector<JsonNode> items = node.items(2, 2);
    return {coordinate(items[0]), coordinate(items[1])};
}

std::array<double, 3> circle(const JsonNode& node) {
    const std::vector<JsonNode> items = node.items(3, 3);
    return {coordinate(items[0]), coordinate(items[1]), items[2].number(0, kFarthest)};
}

Id vertex(const JsonNode& node) {
    return static_cast<Id>(node.whole(kNone - 1));
}

constexpr const char* kSelectors = "vertex, vertices, near, circle, beyond, box or border";

VertexSelection selection(const JsonNode& node) {
    VertexSelection s;
    s.where = node.place();
    int given = 0;
    for (const char* name : {"vertex", "vertices", "near", "circle", "beyond", "box", "border"}) {
        if (!node.has(name)) continue;
        if (++given > 1) node.refuse(cat("expected only one of ", kSelectors));
        s.where = node[name].place();
    }
    if (given == 0) node.refuse(cat("expected one of ", kSelectors));
    if (node.has("vertex")) s.vertices = {vertex(node["vertex"])};
    if (node.has("vertices"))
        for (const JsonNode& item : node["vertices"].items(1, std::numeric_limits<std::size_t>::max()))
            s.vertices.push_back(vertex(item));
    if (node.has("near")) s.near = point(node["near"]);
    if (node.has("circle")) s.circle = circle(node["circle"]);
    if (node.has("beyond")) s.beyond = circle(node["beyond"]);
    if (node.has("box")) {
        const std::vector<JsonNode> items = node["box"].items(4, 4);
        s.box = {coordinate(items[0]), coordinate(items[1]), coordinate(items[2]), coordinate(items[3])};
    }
    if (node.has("border")) {
        if (!node["border"].is_true()) node["border"].refuse("expected true");
        s.border = true;
    }
    return s;
}

WarpHandle handle(const JsonNode& node) {
    node.check_members({"vertex", "vertices", "near", "circle", "beyond", "box", "border", "move", "rotate",
                        "scale", "center"});
    WarpHandle h;
    h.vertices = selection(node);
    if (!node.has("move") && !node.has("rotate") && !node.has("scale"))
        node.refuse("expected move, rotate or scale");
    if (node.has("move")) h.move = point(node["move"]);
    if (node.has("rotate")) h.rotate_deg = node["rotate"].number(-kFarthest, kFarthest);
    if (node.has("scale")) {
        const JsonNode scale = node["scale"];
        const auto factor = [](const JsonNode& n) { return n.number(kSmallestScale, kLargestScale); };
        if (scale.is_number()) {
            h.scale = Vec2d::Constant(factor(scale));
        } else {
            const std::vector<JsonNode> items = scale.items(2, 2);
            h.scale = {factor(items[0]), factor(items[1])};
        }
    }
    if (node.has("center")) h.center = point(node["center"]);
    return h;
}

WarpEdit edit(const JsonNode& node) {
    node.check_members({"name", "level", "solver", "handles", "pins"});
    WarpEdit e;
    e.where = node.place();
    if (node.has("level")) {
        e.level = static_cast<int>(node["level"].whole(std::numeric_limits<int>::max()));
        e.where = node["level"].place();
    }
    if (node.has("solver")) {
        if (node["solver"].is_text("arap"))
            e.solver = WarpSolver::kArap;
        else if (node["solver"].is_text("injective"))
            e.solver = WarpSolver::kInjective;
        else if (!node["solver"].is_text("direct"))
            node["solver"].refuse("expected \"direct\", \"arap\" or \"injective\"");
    }
    if (!node.has("handles")) node.refuse("member \"handles\" is missing");
    for (const JsonNode& item : node["handles"].items()) e.handles.push_back(handle(item));
    if (node.has("pins"))
        for (const JsonNode& item : node["pins"].items()) {
            item.check_members({"vertex", "vertices", "near", "circle", "beyond", "box", "border"});
            e.pins.push_back(selection(item));
        }
    return e;
}

json parse(std::string_view text, const std::string& name, const EditLimits& limits) {
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    if (const std::string_view image = image_signature(bytes); !image.empty() || has_glb_signature(bytes))
        throw Error(ErrorKind::kBadFile,
                    cat(name, ": no JSON but ", image.empty() ? "a container" : cat("an image (", image, ")"),
                        ", expected a file of edits"));
    return whole_json(text, name, {limits.max_json_depth, limits.max_json_values});
}

}  // namespace

WarpEdits edits_from_json(std::string_view text, const std::string& name, const EditLimits& limits) {
    const json document = parse(text, name, limits);
    const JsonNode root(document, name + ": ");
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::kBadFile, cat(name, ": ", what));
    };
    if (!document.is_object()) refuse(cat("expected an object, found ", document.type_name()));
    for (const auto& [member, ignored] : document.items())
        if (member != "$schema" && member != "edits")
            refuse(cat("unknown member ", json(member).dump(-1, ' ', true, json::error_handler_t::replace)));
    if (document.contains("$schema") && !document["$schema"].is_string())
        refuse("/$schema: expected a string");
    if (!document.contains("edits")) refuse("member \"edits\" is missing");
    WarpEdits edits;
    for (const JsonNode& item : root["edits"].items()) edits.push_back(edit(item));
    return edits;
}

WarpEdits read_edits(const std::string& path, const EditLimits& limits) {
    const std::vector<std::uint8_t> bytes = read_file(path, limits.max_bytes);
    return edits_from_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, limits);
}

}  // namespace imgmesh
