// The samples of a TIFF: unpacked from bits, and from blocks into the whole image.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/picture/decode/tiff_rows.h"

namespace imgmesh {

/// Writes `count` samples, which lie one after another in `row`, to out[0], out[step], ... Integers become
/// their own numbers, rounded to floats. `row` is as libtiff gives it: samples of 16, 24, 32 and 64 bits in
/// the machine's byte order, others as a stream of bits, the most significant first. It must hold them all.
/// Source of the 24-bit float: TIFF Technical Note 3.
void unpack_samples(std::span<const std::uint8_t> row, std::size_t count, TiffSamples kind, int bits,
                    float* out, std::size_t step);

/// Throws Error(kBadFile) if the current page has not the blocks that its size asks for.
void check_block_count(const TiffFile& file, const TiffLayout& layout);

/// Returns the samples of the current page in `area`, interleaved, as their own numbers; the chroma of
/// subsampled YCbCr is repeated. Only blocks that the area touches are read, each once. Blocks that the file
/// leaves out (offset and length 0) are `fill`, or an error without one. Throws Error(kBadFile) for blocks
/// that are broken or not complete; for blocks outside of the file before memory is taken. With `rows` strips
/// are undone row by row.
std::vector<float> read_samples(TiffFile& file, const TiffLayout& layout, const PixelRect& area,
                                std::optional<float> fill, TiffRows* rows = nullptr);

}  // namespace imgmesh
