// Words for the values of options.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "libcore/base/error.h"
#include "tools/common/did_you_mean.h"
#include "tools/common/text.h"

namespace imgmesh {

template <typename Value>
using Choices = std::vector<std::pair<std::string, Value>>;

/// Returns the word of a value that is among the choices.
template <typename Value>
std::string name_of(const Choices<Value>& choices, const Value& value) {
    for (const auto& [name, candidate] : choices) {
        if (candidate == value) return name;
    }
    throw std::logic_error("a value without a name");
}

/// Returns the words of `choices`, as in "half, float".
template <typename Value>
std::string choice_names(const Choices<Value>& choices) {
    std::string names;
    for (const auto& choice : choices) names += (names.empty() ? "" : ", ") + choice.first;
    return names;
}

/// Returns whether two words are equal, ignoring the case of ASCII letters.
bool same_name(const std::string& a, const std::string& b);

/// Returns the value of the word `text`, in any case, given to option `name`.
template <typename Value>
Value parse_choice(const std::string& name, const std::string& text, const Choices<Value>& choices) {
    for (const auto& [word, value] : choices)
        if (same_name(word, text)) return value;
    std::vector<std::string> words;
    for (const auto& choice : choices) words.push_back(choice.first);
    throw Error(ErrorKind::kBadArgument, cat(name, " '", shortened(text), "': expected one of ",
                                             choice_names(choices), did_you_mean(text, words)));
}

}  // namespace imgmesh
