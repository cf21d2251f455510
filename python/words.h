// Words for values: those of the tools (tools/common/names.h) and of numpy.
#pragma once

#include <optional>
#include <string>

#include "tools/common/names.h"

namespace imgmesh::python {

/// The names of numpy's dtypes.
Choices<SampleType> dtype_names();

/// Returns the value of a word given to the parameter `name`; nothing for none. Throws Error(kBadArgument) as
/// parse_choice() does.
template <typename Value>
std::optional<Value> word_value(const std::string& name, const std::optional<std::string>& word,
                                const Choices<Value>& choices) {
    if (!word) return std::nullopt;
    return parse_choice(name, *word, choices);
}

}  // namespace imgmesh::python
