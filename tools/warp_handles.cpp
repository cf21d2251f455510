#include "tools/warp_handles.h"

#include <string>

#include "libcore/base/error.h"
#include "tools/common/choices.h"
#include "tools/common/options.h"
#include "tools/common/text.h"

namespace imgmesh {
namespace {

const std::string kHandle = "--handle", kPin = "--pin";

// Far outside any image, as in files of edits.
constexpr NumberRange kCoordinate = {-1e6, 1e6};

// Reads "X,Y", a part of `text`, which option `name` has; `expected` is its form.
Vec2d parse_pair(const std::string& name, const std::string& text, const std::string& part,
                 const char* expected) {
    const std::size_t comma = part.find(',');
    if (comma == std::string::npos)
        throw Error(ErrorKind::kBadArgument, cat(name, " '", shortened(text), "': expected ", expected));
    const auto number = [&](const std::string& digits) {
        const bool plus = digits.size() > 1 && digits[0] == '+' && digits[1] != '-';
        return parse_number(name, plus ? digits.substr(1) : digits, kCoordinate);
    };
    return {number(part.substr(0, comma)), number(part.substr(comma + 1))};
}

WarpHandle parse_handle(const std::string& text) {
    constexpr const char* kForm = "X,Y:DX,DY, as in 250,260:30,-15";
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos)
        throw Error(ErrorKind::kBadArgument, cat(kHandle, " '", shortened(text), "': expected ", kForm));
    WarpHandle handle;
    handle.vertices.near = parse_pair(kHandle, text, text.substr(0, colon), kForm);
    handle.vertices.where = cat(kHandle, " ", text);
    handle.move = parse_pair(kHandle, text, text.substr(colon + 1), kForm);
    return handle;
}

VertexSelection parse_pin(const std::string& text) {
    VertexSelection pin;
    pin.near = parse_pair(kPin, text, text, "X,Y, as in 250,260");
    pin.where = cat(kPin, " ", text);
    return pin;
}

}  // namespace

void add_handle_options(CLI::App& app, HandleOptions& o) {
    const std::string group = "Edit";
    CLI::Option* const handle = add_values(
        app, kHandle, "X,Y:DX,DY",
        [&o](const std::string& text) { o.edit.handles.push_back(parse_handle(text)); },
        "Move the vertex nearest to X,Y by DX,DY pixels; may be given several times");
    CLI::Option* const pin = add_values(
        app, kPin, "X,Y", [&o](const std::string& text) { o.edit.pins.push_back(parse_pin(text)); },
        "Hold the vertex nearest to X,Y, while all others follow the handles; may be given several times");
    CLI::Option* const border = add_flag(
        app, "--pin-border",
        [&o] {
            o.edit.pins.emplace_back();
            o.edit.pins.back().border = true;
            o.edit.pins.back().where = "--pin-border";
        },
        "Hold all vertices on the mesh's boundary that no handle moves");
    CLI::Option* const level = add_count(app, "--level", o.edit.level, {0},
                                         "Level of the pyramid that handles and pins are of, 0 the finest");
    CLI::Option* const solver = add_choice(
        app, "--solver", o.solver,
        Choices<WarpSolver>{{"direct", WarpSolver::kDirect},
                            {"arap", WarpSolver::kArap},
                            {"injective", WarpSolver::kInjective}},
        {"What moves beside the handles' vertices: nothing, or all but pins, as rigidly as possible, or so "
         "that no face turns over",
         "direct, with pins arap"});
    in_group(handle, group);
    for (CLI::Option* const option : {pin, border, level, solver}) needs(in_group(option, group), handle);
}

std::optional<WarpEdit> handle_edit(const HandleOptions& o) {
    if (o.edit.handles.empty()) return std::nullopt;
    WarpEdit edit = o.edit;
    edit.solver = o.solver.value_or(edit.pins.empty() ? WarpSolver::kDirect : WarpSolver::kArap);
    edit.where = cat("--level ", edit.level);
    return edit;
}

std::vector<std::string> far_points(const WarpEdits& edits, const SourceInfo& source) {
    constexpr double kNear = 8;  // a hand may miss the edge by this [pixels]
    std::vector<std::string> lines;
    const auto look = [&](const VertexSelection& selection) {
        if (!selection.near) return;
        const Vec2d last(source.width - 1, source.height - 1);
        const double away = (*selection.near - selection.near->cwiseMax(Vec2d(0, 0)).cwiseMin(last)).norm();
        if (away > kNear)
            lines.push_back(cat(selection.where, ": the point is ", format_number(away),
                                " pixels outside the image; the vertex nearest to it counts"));
    };
    for (const WarpEdit& edit : edits) {
        for (const WarpHandle& handle : edit.handles) look(handle.vertices);
        for (const VertexSelection& pin : edit.pins) look(pin);
    }
    return lines;
}

}  // namespace imgmesh
