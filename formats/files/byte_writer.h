// Writes numbers as the bytes of a file.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/files/byte_reader.h"

namespace imgmesh {

/// Appends the lowest `count` bytes of a number, 1 to 8.
inline void append_number(std::vector<std::uint8_t>& out, std::uint64_t value, int count, ByteOrder order) {
    for (int i = 0; i < count; ++i)
        out.push_back(static_cast<std::uint8_t>(value >> 8 * (order == ByteOrder::kBig ? count - 1 - i : i)));
}

}  // namespace imgmesh
