// What the first bytes of a file say about the image in it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace imgmesh {

/// Returns the format's name, as "PNG" or "JPEG 2000", or "" for bytes that begin as no image that has a
/// signature there.
std::string_view image_signature(std::span<const std::uint8_t> bytes);

/// Returns whether bytes begin as a coded picture does (.imgm, docs/codec-format.md).
bool has_coded_signature(std::span<const std::uint8_t> bytes);

/// Returns whether bytes begin as a binary glTF file does.
bool has_glb_signature(std::span<const std::uint8_t> bytes);

}  // namespace imgmesh
