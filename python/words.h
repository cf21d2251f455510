// Words for values, as the tools have them.
#pragma once

#include <optional>
#include <string>

#include "formats/picture/image_io.h"
#include "formats/picture/texture_file.h"
#include "libcore/pipeline/build_source.h"
#include "libcore/recon/draw.h"
#include "libcore/segment/segment.h"
#include "tools/common/names.h"

namespace imgmesh::python {

Choices<DrawMode> draw_modes();
Choices<DistanceRule> distance_rules();
Choices<AlphaUse> alpha_uses();
Choices<NonFinite> non_finite_rules();
Choices<TextureType> texture_types();
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
