// The binary file variant of glTF: a header, a JSON chunk and a binary chunk.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace imgmesh {

class Findings;

struct GlbView {
    std::string_view json;
    std::span<const std::uint8_t> binary;  ///< empty without a binary chunk
};

/// Whether the bytes start as a GLB does; else they are taken for JSON.
bool is_glb(std::span<const std::uint8_t> bytes);

/// What stands in the file before the bytes of the binary chunk, which are a multiple of four. Throws
/// Error(kUnsupported) above 4 GiB, which the format cannot say.
std::vector<std::uint8_t> glb_head(std::string_view json, std::uint64_t binary_bytes);

/// The whole file. Throws as glb_head() does.
std::vector<std::uint8_t> pack_glb(std::string_view json, std::span<const std::uint8_t> binary);

/// Views into `bytes`. Unknown chunks are skipped. Throws FindingError.
GlbView unpack_glb(std::span<const std::uint8_t> bytes, Findings& findings);

}  // namespace imgmesh
