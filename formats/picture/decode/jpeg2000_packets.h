// How many packets a JPEG 2000 codestream speaks of.
#pragma once

#include <cstdint>
#include <span>

namespace imgmesh {

/// The grid of tiles of a codestream, of its SIZ marker.
struct Jpeg2000Tiles {
    std::int64_t count;          ///< in the whole image
    std::int64_t width, height;  ///< of the largest [pixels]
    std::int64_t channels;
};

/// Returns the number of packets that a decoder of the codestream steps through, at most 2^62: one for each
/// layer, resolution, channel and precinct of each tile, once more for each change of the progression. Where
/// headers of tiles or channels differ, the largest of their numbers is taken for all.
///
/// codestream  from its SOC marker on. What is cut off or unknown counts nothing.
///
/// Time is O(markers). Source: T.800 A.4.2 (tile-parts), A.6.1 (COD), A.6.2 (COC), A.6.6 (POC), B.9
/// (packets).
std::int64_t count_packets(std::span<const std::uint8_t> codestream, const Jpeg2000Tiles& tiles);

}  // namespace imgmesh
