// The tokens of a chunk of which all values are known: the encoder need not go from pixel to pixel. Internal
// to this room.
#pragma once

#include <cstdint>

#include "formats/compact/band_pixel.h"

namespace imgmesh::compact {

/// What a chunk's pixels are coded as, dx and dy: context * kTokens + token, and the numbers of the
/// residuals.
struct ChunkTokens {
    std::array<Chunk::Pixels<std::uint16_t>, 2> tokens;
    std::array<Chunk::Pixels<std::int32_t>, 2> numbers;
};

/// Finds the tokens of the first `count` pixels of the chunk, eight at a time. Their values are set; all else
/// that code_pixel() notes is set here, in the lane too. The same as code_pixel() for one after the other.
void find_tokens(Lane& lane, int count, ChunkTokens& found);

}  // namespace imgmesh::compact
