// What tells a TGA file: it has no signature at its begin.
#pragma once

#include <cstdint>
#include <span>

#include "formats/files/byte_reader.h"

namespace imgmesh {

/// Whether the file ends as TGA files of version 2 do: 26 bytes with a signature in the last 18.
inline bool has_tga_footer(std::span<const std::uint8_t> bytes) {
    constexpr std::string_view kSignature("TRUEVISION-XFILE.\0", 18);
    return bytes.size() >= 26 && text_of(bytes).ends_with(kSignature);
}

}  // namespace imgmesh
