// Makes an EXR's header safe for OpenEXR to read.
#pragma once

#include <cstdint>
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

}  // namespace imgmesh
