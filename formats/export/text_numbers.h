// Numbers as the text formats of other programs write them. Private to this folder.
#pragma once

#include <algorithm>
#include <charconv>
#include <string>

namespace imgmesh {

/// Returns the shortest text that reads back as the same float, in any locale; no negative zero.
inline std::string number_text(float value) {
    char text[64];
    const auto end = std::to_chars(text, text + sizeof text, value + 0.0f).ptr;
    return {text, end};
}

/// Returns a coordinate in pixels from the top-left corner of the image, along one axis, inside the image.
inline float from_corner(float x, int side) {
    return std::clamp(x + 0.5f, 0.0f, static_cast<float>(side));
}

/// Returns the texts of items 0 to count - 1, joined by `separator`.
template <typename TextOf>
std::string joined_text(std::size_t count, const char* separator, TextOf text_of) {
    std::string out;
    for (std::size_t i = 0; i < count; ++i) out += (i == 0 ? "" : separator) + text_of(i);
    return out;
}

}  // namespace imgmesh
