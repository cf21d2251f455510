#include "web/engine/build_arguments.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <vector>

#include "libcore/base/error.h"
#include "libcore/pipeline/param_table.h"
#include "libcore/pipeline/params.h"
#include "libcore/pipeline/presets.h"

namespace imgmesh::web {

using emscripten::val;

namespace {

[[noreturn]] void refuse_type(const std::string& name, const char* expected) {
    throw Error(ErrorKind::kBadArgument, cat(name, ": expected ", expected));
}

template <typename Kind, typename T>
void check_range(const std::string& name, const Kind& kind, const T& value) {
    if (!contains(kind.range, value))
        throw Error(ErrorKind::kBadArgument, cat(name, " is ", value, ", expected ", describe(kind.range)));
}

double number(const std::string& name, const val& value) {
    if (!value.isNumber()) refuse_type(name, "a number");
    return value.as<double>();
}

std::int64_t whole_number(const std::string& name, const val& value) {
    constexpr double kLargest = 9007199254740992.0;  // 2^53: beyond, numbers of JavaScript are not exact
    const double x = number(name, value);
    if (x != std::floor(x) || std::abs(x) > kLargest) refuse_type(name, "a whole number");
    return static_cast<std::int64_t>(x);
}

template <typename Kind, typename T>
std::vector<T> list(const std::string& name, const val& value, const Kind& kind,
                    T (*parse)(const std::string&, const val&)) {
    if (!value.isArray()) refuse_type(name, "a list of numbers");
    std::vector<T> values;
    const unsigned length = value["length"].as<unsigned>();
    for (unsigned i = 0; i < length; ++i) {
        values.push_back(parse(name, value[i]));
        check_range(name, kind, values.back());
    }
    return values;
}

std::int64_t parse(const std::string& name, const val& value, const CountParam& kind) {
    const std::int64_t x = whole_number(name, value);
    check_range(name, kind, x);
    return x;
}

double parse(const std::string& name, const val& value, const NumberParam& kind) {
    const double x = number(name, value);
    check_range(name, kind, x);
    return x;
}

std::vector<std::int64_t> parse(const std::string& name, const val& value, const CountListParam& kind) {
    return list(name, value, kind, whole_number);
}

std::vector<double> parse(const std::string& name, const val& value, const NumberListParam& kind) {
    return list(name, value, kind, number);
}

bool parse(const std::string& name, const val& value, const FlagParam&) {
    if (!value.isTrue() && !value.isFalse()) refuse_type(name, "true or false");
    return value.isTrue();
}

std::size_t parse(const std::string& name, const val& value, const WordParam& kind) {
    if (!value.isString()) refuse_type(name, "a word");
    const std::string word = value.as<std::string>();
    const auto at = std::find(kind.words.begin(), kind.words.end(), word);
    if (at != kind.words.end()) return static_cast<std::size_t>(at - kind.words.begin());
    std::string words;
    for (const std::string_view other : kind.words) words += (words.empty() ? "" : ", ") + std::string(other);
    throw Error(ErrorKind::kBadArgument, cat(name, " '", word, "': expected one of ", words));
}

// Pixels of a canvas have no other channels.
std::vector<ChannelChoice> parse(const std::string& name, const val&, const ChannelsParam&) {
    throw Error(ErrorKind::kBadArgument, cat(name, ": pixels have the channels R, G, B and A alone"));
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

std::string argument_text(std::string_view name, std::string_view value) {
    const bool number = !value.empty() && (std::isdigit(static_cast<unsigned char>(value.front())) != 0);
    if (value.empty()) return cat(name, ": true");
    return number ? cat(name, ": ", value) : cat(name, ": \"", value, "\"");
}

BuildParams build_params_from(const val& arguments) {
    BuildParams params;
    const val preset = arguments["preset"];
    if (!preset.isUndefined()) {
        if (!preset.isString()) refuse_type("preset", "a word");
        params = params_of(preset.as<std::string>());
    }
    std::vector<std::string> given;
    const val names = val::global("Object").call<val>("keys", arguments);
    for (unsigned i = 0; i < names["length"].as<unsigned>(); ++i) {
        const auto name = names[i].as<std::string>();
        if (name == "preset" || arguments[name].isUndefined()) continue;
        const auto param = std::find_if(param_table().begin(), param_table().end(),
                                        [&](const Param& p) { return p.name == name; });
        if (param == param_table().end())
            throw Error(ErrorKind::kBadArgument, cat("there is no parameter '", name, "'"));
        given.push_back(name);
    }
    // In the order of the table, as the order of members must not matter.
    const auto is_given = [&](const std::string& name) {
        return std::find(given.begin(), given.end(), name) != given.end();
    };
    for (const Param& param : param_table()) {
        if (!is_given(param.name)) continue;
        const val value = arguments[param.name];
        std::visit([&](const auto& kind) { kind.set(params, parse(param.name, value, kind)); }, param.kind);
    }
    for (const Param& param : param_table()) {
        if (!is_given(param.name)) continue;
        for (const std::string& other : param.excludes)
            if (is_given(other))
                throw Error(ErrorKind::kBadArgument,
                            cat(param.name, " and ", other, ": expected one of them"));
    }
    check_params(params);
    return params;
}

val list_build_params() {
    val all = val::array();
    for (const Param& param : param_table()) {
        val row = val::object();
        row.set("name", param.name);
        row.set("group", param.group);
        row.set("help", param.help);
        row.set("default", default_text(param));
        if (const auto* kind = std::get_if<WordParam>(&param.kind)) {
            val words = val::array();
            for (const std::string_view word : kind->words) words.call<void>("push", std::string(word));
            row.set("words", words);
        }
        all.call<void>("push", row);
    }
    return all;
}

}  // namespace imgmesh::web
