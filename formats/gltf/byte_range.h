// Where arrays are in the asset's one buffer.
#pragma once

#include <cstdint>
#include <vector>

namespace imgmesh {

/// Bytes of the buffer.
struct ByteRange {
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
    bool operator==(const ByteRange&) const = default;
};

/// Appends values as they lie in memory, then zeros up to a multiple of four, where the next may start.
template <typename T>
ByteRange append_values(std::vector<std::uint8_t>& buffer, const std::vector<T>& values) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
    const ByteRange range{buffer.size(), values.size() * sizeof(T)};
    buffer.insert(buffer.end(), first, first + range.length);
    buffer.resize((buffer.size() + 3) / 4 * 4, 0);
    return range;
}

}  // namespace imgmesh
