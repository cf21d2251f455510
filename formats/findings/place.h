// Places in a container.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace imgmesh {

/// Where in a container something was found. Members that do not apply are empty.
struct Place {
    /// JSON pointer into the glTF document (RFC 6901), such as "/nodes/0/mesh".
    std::string pointer;
    std::string part;                                              ///< name of a part of the EXR
    std::string channel;                                           ///< name of a channel of that part
    std::optional<std::pair<std::uint64_t, std::uint64_t>> pixel;  ///< x, y
    std::string bytes_of;               ///< what `byte` counts in: "file", "draco" or "layers"
    std::optional<std::uint64_t> byte;  ///< offset, from 0
};

/// A place with only these members.
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
