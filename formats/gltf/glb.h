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

/// Returns whether the bytes start like a GLB; otherwise they count as JSON.
bool is_glb(std::span<const std::uint8_t> bytes);

/// Returns the bytes before the binary chunk's content, whose length is a multiple of four. Throws
/// Error(kUnsupported) above 4 GiB, which the format cannot express.
std::vector<std::uint8_t> glb_head(std::string_view json, std::uint64_t binary_bytes);

/// Returns the whole file. Throws as glb_head() does.
std::vector<std::uint8_t> pack_glb(std::string_view json, std::span<const std::uint8_t> binary);

/// Returns views into `bytes`. Unknown chunks are skipped. Throws FindingError.
GlbView unpack_glb(std::span<const std::uint8_t> bytes, Findings& findings);

}  // namespace imgmesh
