#include "formats/container/edit_file.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "formats/files/atomic_file.h"
#include "formats/files/image_signature.h"
#include "formats/findings/findings.h"
#include "formats/findings/json_parse.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using nlohmann::json;

// Far outside any image, and far below the numbers that lose their fractions.
constexpr double kFarthest = 1e6;
constexpr double kSmallestScale = 1e-3, kLargestScale = 1e3;

// A value and its place.
class Node {
  public:
    Node(const json& value, std::string place) : value_(value), place_(std::move(place)) {}

    const std::string& place() const { return place_; }
    [[noreturn]] void refuse(const std::string& text) const {
        throw Error(ErrorKind::kBadFile, cat(place_, ": ", text));
    }

    bool has(const char* name) const { return value_.contains(name); }
    Node operator[](const char* name) const { return {value_.at(name), cat(place_, "/", name)}; }
    std::vector<Node> items(std::size_t least, std::size_t most) const {
        if (!value_.is_array()) refuse(cat("expected an array, found ", value_.type_name()));
        if (value_.size() < least || value_.size() > most)
            refuse(least == most ? cat("expected ", least, " items, found ", value_.size())
                                 : cat("expected at least ", least, " item, found none"));
        std::vector<Node> all;
        all.reserve(value_.size());
        for (std::size_t i = 0; i < value_.size(); ++i) all.emplace_back(value_[i], cat(place_, "/", i));
        return all;
    }
    std::vector<Node> items() const { return items(0, std::numeric_limits<std::size_t>::max()); }

    // Checks that this is an object with no other members than these.
    void check_members(std::initializer_list<const char*> names) const {
        if (!value_.is_object()) refuse(cat("expected an object, found ", value_.type_name()));
        for (const auto& [name, ignored] : value_.items())
            if (std::find(names.begin(), names.end(), name) == names.end())
                refuse(
                    cat("unknown member ", json(name).dump(-1, ' ', true, json::error_handler_t::replace)));
    }
    double number(double least, double most) const {
        if (!value_.is_number()) refuse(cat("expected a number, found ", value_.type_name()));
        const auto number = value_.get<double>();
        if (!(number >= least && number <= most))
            refuse(cat("expected a number from ", least, " to ", most, ", found ", number));
        return number;
    }
    std::int64_t whole(std::int64_t most) const {
        if (!value_.is_number()) refuse(cat("expected a whole number, found ", value_.type_name()));
        const auto number = value_.get<double>();
        // A schema counts 2.0 as a whole number, and so does this.
        if (!(number >= 0 && number <= double(most)) || number != std::floor(number))
            refuse(cat("expected a whole number from 0 to ", most, ", found ", value_.dump()));
        return static_cast<std::int64_t>(number);
    }
    bool is_number() const { return value_.is_number(); }
    bool is_true() const { return value_.is_boolean() && value_.get<bool>(); }
    bool is_text(const char* text) const {
        return value_.is_string() && value_.get_ref<const std::string&>() == text;
    }

  private:
    const json& value_;
    std::string place_;
};

double coordinate(const Node& node) {
    return node.number(-kFarthest, kFarthest);
}

Vec2d point(const Node& node) {
    const std::vector<Node> items = node.items(2, 2);
    return {coordinate(items[0]), coordinate(items[1])};
}

std::array<double, 3> circle(const Node& node) {
    const std::vector<Node> items = node.items(3, 3);
    return {coordinate(items[0]), coordinate(items[1]), items[2].number(0, kFarthest)};
}

Id vertex(const Node& node) {
    return static_cast<Id>(node.whole(kNone - 1));
}

constexpr const char* kSelectors = "vertex, vertices, near, circle, beyond, box or border";

VertexSelection selection(const Node& node) {
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
        for (const Node& item : node["vertices"].items(1, std::numeric_limits<std::size_t>::max()))
            s.vertices.push_back(vertex(item));
    if (node.has("near")) s.near = point(node["near"]);
    if (node.has("circle")) s.circle = circle(node["circle"]);
    if (node.has("beyond")) s.beyond = circle(node["beyond"]);
    if (node.has("box")) {
        const std::vector<Node> items = node["box"].items(4, 4);
        s.box = {coordinate(items[0]), coordinate(items[1]), coordinate(items[2]), coordinate(items[3])};
    }
    if (node.has("border")) {
        if (!node["border"].is_true()) node["border"].refuse("expected true");
        s.border = true;
    }
    return s;
}

WarpHandle handle(const Node& node) {
    node.check_members({"vertex", "vertices", "near", "circle", "beyond", "box", "border", "move", "rotate",
                        "scale", "center"});
    WarpHandle h;
    h.vertices = selection(node);
    if (!node.has("move") && !node.has("rotate") && !node.has("scale"))
        node.refuse("expected move, rotate or scale");
    if (node.has("move")) h.move = point(node["move"]);
    if (node.has("rotate")) h.rotate_deg = node["rotate"].number(-kFarthest, kFarthest);
    if (node.has("scale")) {
        const Node scale = node["scale"];
        const auto factor = [](const Node& n) { return n.number(kSmallestScale, kLargestScale); };
        if (scale.is_number()) {
            h.scale = Vec2d::Constant(factor(scale));
        } else {
            const std::vector<Node> items = scale.items(2, 2);
            h.scale = {factor(items[0]), factor(items[1])};
        }
    }
    if (node.has("center")) h.center = point(node["center"]);
    return h;
}

WarpEdit edit(const Node& node) {
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
    for (const Node& item : node["handles"].items()) e.handles.push_back(handle(item));
    if (node.has("pins"))
        for (const Node& item : node["pins"].items()) {
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
    Findings findings = Findings::collecting();
    json document;
    std::string refusal;
    try {
        document = parse_json(text, {limits.max_json_depth, limits.max_json_values}, findings);
        // In a container a duplicate member is a warning; here one of the two would be lost.
        for (const Issue& issue : findings.issues())
            if (issue.finding->code == std::string_view("json.duplicate")) refusal = issue.text;
    } catch (const FindingError& error) {
        refusal = cat(error.code() == "json.syntax" ? "no JSON: " : "", error.what());
    }
    if (!refusal.empty()) throw Error(ErrorKind::kBadFile, cat(name, ": ", refusal));
    return document;
}

}  // namespace

WarpEdits edits_from_json(std::string_view text, const std::string& name, const EditLimits& limits) {
    const json document = parse(text, name, limits);
    const Node root(document, name + ": ");
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
    for (const Node& item : root["edits"].items()) edits.push_back(edit(item));
    return edits;
}

WarpEdits read_edits(const std::string& path, const EditLimits& limits) {
    const std::vector<std::uint8_t> bytes = read_file(path, limits.max_bytes);
    return edits_from_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, limits);
}

}  // namespace imgmesh
