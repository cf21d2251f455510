// The place of a finding in a container.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace imgmesh {

/// Members that do not apply are empty.
struct Place {
    /// JSON pointer into the glTF document (RFC 6901). In a FindingError, one without a leading / is relative
    /// to the pointer given to Findings::attempt().
    std::string pointer;
    std::string part;                                              ///< of the EXR
    std::string channel;                                           ///< of that part
    std::optional<std::pair<std::uint64_t, std::uint64_t>> pixel;  ///< x, y
    std::string bytes_of;                                          ///< "file", "draco" or "layers"
    std::optional<std::uint64_t> byte;                             ///< offset in it
};

inline Place at_pointer(std::string pointer) {
    Place place;
    place.pointer = std::move(pointer);
    return place;
}
inline Place at_part(std::string part, std::string channel = {}) {
    Place place;
    place.part = std::move(part);
    place.channel = std::move(channel);
    return place;
}
inline Place at_byte(std::string bytes_of, std::uint64_t byte) {
    Place place;
    place.bytes_of = std::move(bytes_of);
    place.byte = byte;
    return place;
}

}  // namespace imgmesh
