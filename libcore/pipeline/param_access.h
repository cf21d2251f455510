// How the rows of the table of parameters access the members of BuildParams.
#pragma once

#include <algorithm>
#include <cassert>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "libcore/pipeline/param_table.h"

namespace imgmesh {

/// A member of BuildParams, or of one of its members.
template <typename Params, typename Field>
auto& member(Params& params, Field field) {
    return params.*field;
}
template <typename Params, typename Part, typename Field>
auto& member(Params& params, Part part, Field field) {
    return params.*part.*field;
}

template <typename T>
struct Chosen {
    using Type = T;
};
template <typename T>
struct Chosen<std::optional<T>> {
    using Type = T;
};

/// A member, or the value of an optional one; an empty list means that nothing is chosen.
template <typename Kind, typename... Path>
Kind access(Path... path) {
    using Value = typename Kind::Value;
    Kind kind;
    kind.get = [path...](const BuildParams& params) -> std::optional<Value> {
        const auto& value = member(params, path...);
        if constexpr (requires { value.empty(); }) {
            if (value.empty()) return std::nullopt;
        }
        return value;
    };
    kind.set = [path...](BuildParams& params, const Value& value) {
        auto& target = member(params, path...);
        target = static_cast<typename Chosen<std::remove_cvref_t<decltype(target)>>::Type>(value);
    };
    return kind;
}

template <typename Kind, typename Range, typename... Path>
Kind ranged(const Range& range, Path... path) {
    auto kind = access<Kind>(path...);
    kind.range = range;
    return kind;
}

template <typename... Path>
CountParam count(const CountRange& range, Path... path) {
    return ranged<CountParam>(range, path...);
}
template <typename... Path>
NumberParam number(const NumberRange& range, Path... path) {
    return ranged<NumberParam>(range, path...);
}
template <typename... Path>
CountListParam counts(const CountRange& range, Path... path) {
    return ranged<CountListParam>(range, path...);
}
template <typename... Path>
NumberListParam numbers(const NumberRange& range, Path... path) {
    return ranged<NumberListParam>(range, path...);
}

/// The words of a member's values.
template <typename Field, typename Value>
WordParam words(Field BuildParams::*field, std::vector<std::pair<std::string_view, Value>> choices) {
    WordParam kind;
    for (const auto& [word, value] : choices) kind.words.push_back(word);
    kind.get = [field, choices](const BuildParams& params) -> std::optional<std::size_t> {
        const std::optional<Value> value = params.*field;
        if (!value) return std::nullopt;
        const auto at =
            std::find_if(choices.begin(), choices.end(), [&](const auto& c) { return c.second == *value; });
        assert(at != choices.end());
        return static_cast<std::size_t>(at - choices.begin());
    };
    kind.set = [field, choices](BuildParams& params, std::size_t index) {
        params.*field = choices.at(index).second;
    };
    return kind;
}

template <typename Value>
std::vector<std::pair<std::string_view, Value>> named(std::initializer_list<Value> values,
                                                      std::string_view (*name)(Value)) {
    std::vector<std::pair<std::string_view, Value>> choices;
    for (const Value value : values) choices.emplace_back(name(value), value);
    return choices;
}

}  // namespace imgmesh
