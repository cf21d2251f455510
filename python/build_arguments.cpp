#include "python/build_arguments.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cctype>
#include <vector>

#include "libcore/base/error.h"
#include "libcore/pipeline/param_table.h"
#include "libcore/pipeline/params.h"
#include "libcore/pipeline/presets.h"
#include "python/read_arguments.h"

namespace imgmesh::python {

namespace py = pybind11;

namespace {

// Returns `object` as T. A whole number may be any that Python counts with, numpy's too.
template <typename T>
T value_as(const std::string& name, const py::handle& object, const char* expected) {
    try {
        return object.cast<T>();
    } catch (const py::cast_error&) {
        throw py::type_error(cat(name, ": expected ", expected, ", found ", std::string(py::repr(object))));
    }
}

template <typename Kind, typename T>
void check_range(const std::string& name, const Kind& kind, const T& value) {
    if (!contains(kind.range, value))
        throw Error(ErrorKind::kBadArgument, cat(name, " is ", value, ", expected ", describe(kind.range)));
}

std::int64_t parse(const std::string& name, const py::handle& object, const CountParam& kind) {
    const auto value = value_as<std::int64_t>(name, object, "a whole number");
    check_range(name, kind, value);
    return value;
}

double parse(const std::string& name, const py::handle& object, const NumberParam& kind) {
    const auto value = value_as<double>(name, object, "a number");
    check_range(name, kind, value);
    return value;
}

std::vector<std::int64_t> parse(const std::string& name, const py::handle& object,
                                const CountListParam& kind) {
    auto values = value_as<std::vector<std::int64_t>>(name, object, "a list of whole numbers");
    for (const std::int64_t value : values) check_range(name, kind, value);
    return values;
}

std::vector<double> parse(const std::string& name, const py::handle& object, const NumberListParam& kind) {
    auto values = value_as<std::vector<double>>(name, object, "a list of numbers");
    for (const double value : values) check_range(name, kind, value);
    return values;
}

bool parse(const std::string& name, const py::handle& object, const FlagParam&) {
    return value_as<bool>(name, object, "True or False");
}

std::size_t parse(const std::string& name, const py::handle& object, const WordParam& kind) {
    const auto word = value_as<std::string>(name, object, "a word");
    const auto at = std::ranges::find(kind.words, word);
    if (at != kind.words.end()) return static_cast<std::size_t>(at - kind.words.begin());
    std::string words;
    for (const std::string_view other : kind.words) words += (words.empty() ? "" : ", ") + std::string(other);
    throw Error(ErrorKind::kBadArgument, cat(name, " '", word, "': expected one of ", words));
}

// Names, or a dict of names and weights.
std::vector<ChannelChoice> parse(const std::string& name, const py::handle& object, const ChannelsParam&) {
    std::vector<ChannelChoice> channels;
    if (py::isinstance<py::dict>(object)) {
        for (const auto& [channel, weight] : py::reinterpret_borrow<py::dict>(object))
            channels.push_back({value_as<std::string>(name, channel, "the name of a channel"),
                                value_as<double>(name, weight, "a weight")});
    } else {
        if (py::isinstance<py::str>(object))
            throw py::type_error(name + ": expected a list of names, or a dict of names and weights");
        for (std::string& channel : value_as<std::vector<std::string>>(
                 name, object, "a list of names, or a dict of names and weights"))
            channels.push_back({std::move(channel), 1});
    }
    check_channels(channels);
    return channels;
}

const BuildParams& params_of(const std::string& preset) {
    std::string names;
    for (const Preset& known : presets()) {
        if (known.name == preset) return known.params;
        names += (names.empty() ? "" : ", ") + std::string(known.name);
    }
    throw Error(ErrorKind::kBadArgument, cat("preset '", preset, "': expected one of ", names));
}

}  // namespace

std::string argument_name(std::string_view name) {
    std::string argument(name);
    std::ranges::replace(argument, '-', '_');
    return argument;
}

std::string argument_text(std::string_view name, std::string_view value) {
    const bool number = !value.empty() && (std::isdigit(static_cast<unsigned char>(value.front())) != 0);
    if (value.empty()) return cat(argument_name(name), "=True");
    return number ? cat(argument_name(name), "=", value) : cat(argument_name(name), "='", value, "'");
}

BuildParams take_build_params(py::dict& arguments) {
    const py::object preset = take(arguments, "preset");
    BuildParams params =
        preset.is_none() ? BuildParams() : params_of(value_as<std::string>("preset", preset, "a word"));
    std::vector<std::string> given;
    for (const Param& param : param_table()) {
        const std::string name = argument_name(param.name);
        const py::object value = take(arguments, name.c_str());
        if (value.is_none()) continue;
        given.push_back(param.name);
        std::visit([&](const auto& kind) { kind.set(params, parse(name, value, kind)); }, param.kind);
    }
    for (const Param& param : param_table()) {
        if (std::ranges::find(given, param.name) == given.end()) continue;
        for (const std::string& other : param.excludes)
            if (std::ranges::find(given, other) != given.end())
                throw Error(ErrorKind::kBadArgument, cat(argument_name(param.name), " and ",
                                                         argument_name(other), ": expected one of them"));
    }
    check_params(params);
    return params;
}

py::list list_build_params() {
    py::list all;
    for (const Param& param : param_table()) {
        py::dict row(py::arg("name") = argument_name(param.name), py::arg("group") = param.group,
                     py::arg("help") = param.help, py::arg("default") = default_text(param));
        if (const auto* kind = std::get_if<WordParam>(&param.kind)) {
            py::list words;
            for (const std::string_view word : kind->words) words.append(py::str(word.data(), word.size()));
            row["words"] = words;
        }
        all.append(row);
    }
    return all;
}

}  // namespace imgmesh::python
