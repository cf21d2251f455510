// Where the pixels of a Netpbm file lie, for those that have bytes. Internal to this room.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace imgmesh {

struct PnmRows {
    std::int64_t width = 0, height = 0;
    int channels = 1;
    int bits = 8;                        ///< of a sample: 1, 8, 16 or 32
    bool bottom_up = false;              ///< the last row is the first in the file
    std::uint64_t pixels = 0;            ///< where they begin in the file
    std::string before, between, after;  ///< the header, around its width and its height

    std::uint64_t row_bytes() const {
        return (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(channels * bits) + 7) / 8;
    }
    /// A file of that size, all else alike, to which its pixels are to be appended.
    std::vector<std::uint8_t> header(int of_width, int of_height) const;
};

/// Returns nothing for a file of text. `start` is the beginning of the file. Throws Error(kBadFile) if the
/// header is broken or goes on behind it. Sizes are as stated, not checked.
std::optional<PnmRows> pnm_rows(const std::string& path, std::span<const std::uint8_t> start);

}  // namespace imgmesh
