// Makes an EXR's header safe for OpenEXR to read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace imgmesh {

/// Checks the headers of an EXR file in memory. OpenEXR takes memory for an attribute before it notices that
/// the file is shorter, and reads attributes of most types by its own sizes. Here each has to end within the
/// file. Types that an image does not need (previews, id manifests, ...) are renamed, in `bytes`, to types
/// unknown to OpenEXR, which it skips by the checked size.
///
/// Throws Error(kBadFile) for a broken header.
void make_attributes_opaque(const std::string& path, std::span<std::uint8_t> bytes);

/// The same of the first bytes of a file. Returns how many of them are headers; nothing if the headers go on
/// behind them, and then `bytes` are of no use any more.
std::optional<std::size_t> make_start_opaque(const std::string& path, std::span<std::uint8_t> bytes);

}  // namespace imgmesh
