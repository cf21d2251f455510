// Options that read their values strictly: anything else is refused with Error(kBadArgument) in one line.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "libcore/base/error.h"
#include "tools/common/numbers.h"

namespace imgmesh {

/// An option that calls `take` with its one value. `name` is the long option, perhaps after a short one.
CLI::Option* add_value(CLI::App& app, const std::string& name, const std::string& type,
                       std::function<void(const std::string&)> take, const std::string& help);

/// The files to read: one name, or at least one where `inputs` is a vector. Required.
CLI::Option* add_input(CLI::App& app, const std::string& name, std::string& input, const std::string& help);
CLI::Option* add_inputs(CLI::App& app, const std::string& name, std::vector<std::string>& inputs,
                        const std::string& help);
/// -o, --output. Required.
CLI::Option* add_output(CLI::App& app, std::string& output, const std::string& help);

template <typename Integer>
CLI::Option* add_count(CLI::App& app, const std::string& name, Integer& target, const CountRange& range,
                       const std::string& help) {
    using Value = std::conditional_t<std::is_integral_v<Integer>, Integer, std::int64_t>;
    const CountRange fitting = {range.least,
                                std::min<std::int64_t>(range.most, std::numeric_limits<Value>::max())};
    return add_value(
        app, name, "N",
        [&target, name, fitting](const std::string& text) {
            target = static_cast<Value>(parse_count(name, text, fitting));
        },
        help);
}

template <typename Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, Number& target, const NumberRange& range,
                        const std::string& help) {
    return add_value(
        app, name, "X",
        [&target, name, range](const std::string& text) { target = parse_number(name, text, range); }, help);
}

/// A list, its items separated by commas, each read by `parse`.
template <typename Item>
CLI::Option* add_list(CLI::App& app, const std::string& name, std::vector<Item>& target,
                      std::function<Item(const std::string&)> parse, const std::string& help) {
    return add_value(
        app, name, "LIST",
        [&target, parse](const std::string& text) {
            target.clear();
            for (std::size_t at = 0; at <= text.size();) {
                const std::size_t end = std::min(text.find(',', at), text.size());
                target.push_back(parse(text.substr(at, end - at)));
                at = end + 1;
            }
        },
        help);
}

/// The names of `choices`, as in "half, float".
template <typename Value>
std::string choice_names(const std::vector<std::pair<std::string, Value>>& choices) {
    std::string names;
    for (const auto& choice : choices) names += (names.empty() ? "" : ", ") + choice.first;
    return names;
}

/// Whether two names differ in no more than the case of ASCII letters.
bool same_name(const std::string& a, const std::string& b);

/// One of several names in any case, each standing for a value.
template <typename Target, typename Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Target& target,
                        const std::vector<std::pair<std::string, Value>>& choices, const std::string& help) {
    return add_value(
        app, name, "NAME",
        [&target, name, choices](const std::string& text) {
            for (const auto& [word, value] : choices) {
                if (!same_name(word, text)) continue;
                target = value;
                return;
            }
            throw Error(ErrorKind::kBadArgument,
                        cat(name, " '", text, "': expected one of ", choice_names(choices)));
        },
        help + ": " + choice_names(choices));
}

}  // namespace imgmesh
