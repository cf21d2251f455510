// What the two walks through an EXR's headers know of them. Internal to this room. Source: "OpenEXR File
// Layout", sections "Magic number", "Version field", "Header" and "Attribute types".
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace imgmesh {

inline constexpr std::uint32_t kExrMagic = 20000630;
/// The version field: the version itself, and flags.
inline constexpr std::uint32_t kExrVersionMask = 0xFF, kExrVersion = 2;
inline constexpr std::uint32_t kExrTiled = 0x200, kExrLongNames = 0x400, kExrDeep = 0x800,
                               kExrMultiPart = 0x1000;

/// Whether OpenEXR reads an attribute of this type within `value`. It goes by its own idea of the size: for
/// most types a fixed one, whatever the header says, and for a list of channels up to the empty name at its
/// end. False for types with sizes of their own inside (previews, id manifests, string vectors) and unknown
/// ones. Throws EndOfBytes where a list of channels does not end; `position` is that of the value.
bool has_natural_size(std::string_view type, std::span<const std::uint8_t> value, std::size_t position);

}  // namespace imgmesh
