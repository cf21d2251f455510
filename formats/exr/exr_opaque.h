// An EXR's header, made safe for OpenEXR to read.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace imgmesh {

/// Walks the headers of an EXR file in memory. OpenEXR takes memory for an attribute before it sees that the
/// file is shorter, and reads attributes of most types by sizes of its own; here each has to end within the
/// file, and types that an image does not need (previews, id manifests, ...) are renamed, in `bytes`, to
/// ones that OpenEXR does not know and therefore skips by the size that was checked.
///
/// Throws Error: kBadFile for a broken header, kUnsupported for deep images.
void make_attributes_opaque(const std::string& path, std::span<std::uint8_t> bytes);

}  // namespace imgmesh
