// What both checks of an EXR's headers need. Internal to this room. Source: "OpenEXR File Layout", sections
// "Magic number", "Version field", "Header" and "Attribute types".
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

/// Returns whether OpenEXR reads an attribute of this type within `value`. OpenEXR uses its own idea of the
/// size: for most types a fixed one, whatever the header says, and for a list of channels up to the empty
/// name at its end. Returns false for types with inner sizes (previews, id manifests, string vectors) and
/// unknown ones. Throws EndOfBytes if a list of channels does not end; `position` is that of the value.
bool has_natural_size(std::string_view type, std::span<const std::uint8_t> value, std::size_t position);

}  // namespace imgmesh
