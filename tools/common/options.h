// Options that read their values strictly: anything else is refused with Error(kBadArgument) in one line.
// CLI11 costs seconds in every file that includes it, so this header only names its types.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "libcore/base/error.h"
#include "tools/common/choices.h"
#include "tools/common/numbers.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace imgmesh {

/// What the help says about an option: its meaning and its default.
struct Help {
    Help(const char* what) : text(what) {}
    Help(std::string what, std::string without = "") : text(std::move(what)), otherwise(std::move(without)) {}

    std::string text;       ///< without a full stop
    std::string otherwise;  ///< the default in words; "" if the option's target has it, or if there is none
    bool exact = false;     ///< `otherwise` is what could be typed
};

/// An option that calls `take` with its one value. `name` is the long option, perhaps after a short one.
CLI::Option* add_value(CLI::App& app, const std::string& name, const std::string& type,
                       std::function<void(const std::string&)> take, const Help& help);
/// The same for an option that may be given several times; calls `take` with each value, in order.
CLI::Option* add_values(CLI::App& app, const std::string& name, const std::string& type,
                        std::function<void(const std::string&)> take, const Help& help);
CLI::Option* add_flag(CLI::App& app, const std::string& name, std::function<void()> take,
                      const std::string& help);

/// The files to read, at least one. Required.
CLI::Option* add_inputs(CLI::App& app, const std::string& name, std::vector<std::string>& inputs,
                        const std::string& help);
/// Refuses a command line without `option`.
CLI::Option* require(CLI::Option* option);
/// An option for the name of a file, which is not empty.
CLI::Option* add_file(CLI::App& app, const std::string& name, std::string& target, const std::string& help);

/// Refuses `option` together with the options of these names, and says so in its help.
void exclude(CLI::App& app, CLI::Option* option, const std::vector<std::string>& names);
/// Refuses `option` without `other`.
CLI::Option* needs(CLI::Option* option, CLI::Option* other);
/// Puts an option under this heading of the help; "Options" if none is given.
CLI::Option* in_group(CLI::Option* option, const std::string& group);

/// Calls `check` when all options have been read.
void after_parsing(CLI::App& app, std::function<void()> check);
/// Returns whether the option of this name was given.
bool given(const CLI::App& app, const std::string& name);
/// Returns the first of these options that was given, as it was typed ("--refine 6"); "" if none was.
std::string typed(const CLI::App& app, std::initializer_list<const char*> names);

/// An option as it was given, or not.
struct OptionValue {
    std::string name;  ///< the long one, "--level"
    std::string group;
    bool flag = false;
    std::vector<std::string> values;       ///< as typed; empty if it was not given
    std::optional<std::string> otherwise;  ///< its default, if that could be typed
};
/// Returns all options but the inputs, in the order of the help.
std::vector<OptionValue> option_values(const CLI::App& app);

/// Returns the items of a list, which commas separate.
std::vector<std::string> split_list(const std::string& text);

/// The type of a target's value, optional or not; for decltype.
template <typename T>
T chosen_type(const T&);
template <typename T>
T chosen_type(const std::optional<T>&);

/// Returns `help` with the default in `target`, unless that is an optional one.
template <typename Target>
Help with_default(Help help, const Target& target) {
    if constexpr (std::is_arithmetic_v<Target>) {
        help.otherwise = cat(target);
        help.exact = true;
    }
    return help;
}

template <typename Integer>
CLI::Option* add_count(CLI::App& app, const std::string& name, Integer& target, const CountRange& range,
                       const Help& help) {
    using Value = decltype(chosen_type(target));
    CountRange fitting = range;
    if (std::cmp_greater(range.most, std::numeric_limits<Value>::max()))
        fitting.most = static_cast<std::int64_t>(std::numeric_limits<Value>::max());
    return add_value(
        app, name, "N",
        [&target, name, fitting](const std::string& text) {
            target = static_cast<Value>(parse_count(name, text, fitting));
        },
        with_default(help, target));
}

template <typename Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, Number& target, const NumberRange& range,
                        const Help& help) {
    return add_value(
        app, name, "X",
        [&target, name, range](const std::string& text) { target = parse_number(name, text, range); },
        with_default(help, target));
}

/// An option with several words in any case, each for a value.
template <typename Target, typename Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Target& target, const Choices<Value>& choices,
                        Help help) {
    if constexpr (std::is_same_v<Target, Value>) {
        help.otherwise = name_of(choices, target);
        help.exact = true;
    }
    help.text += ": " + choice_names(choices);
    return add_value(
        app, name, "NAME",
        [&target, name, choices](const std::string& text) { target = parse_choice(name, text, choices); },
        help);
}

}  // namespace imgmesh
