// How the pixels of a TIFF are stored, from its tags.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/picture/decode/tiff_file.h"
#include "formats/picture/image_io.h"

namespace imgmesh {

enum class TiffSamples { kUnsigned, kSigned, kFloat };

struct TiffLayout {
    std::int64_t width = 0, height = 0;
    int samples = 1;  ///< of a pixel
    int bits = 1;     ///< of a sample, 1 to 64
    TiffSamples kind = TiffSamples::kUnsigned;
    bool planar = false;  ///< each sample has blocks of its own
    bool tiled = false;   ///< blocks are tiles, else strips
    std::int64_t block_width = 0, block_height = 0;
    std::uint16_t photometric = 0;
    int chroma_x = 1, chroma_y = 1;     ///< pixels that share a YCbCr image's chroma; 1 after conversion
    std::vector<std::uint16_t> extras;  ///< EXTRASAMPLE_*, of the last samples of a pixel

    int color_samples() const { return samples - static_cast<int>(extras.size()); }
    std::int64_t blocks_across() const { return (width + block_width - 1) / block_width; }
    std::int64_t blocks_down() const { return (height + block_height - 1) / block_height; }
};

/// Makes the first full-size page the current one: not one that is flagged as a thumbnail or as a mask,
/// unless there is no other. Returns whether it had to take such a one. Throws Error(kBadFile).
bool choose_page(TiffFile& file);

/// Returns the layout of the current page, and sets the codecs so that JPEG arrives as RGB and LogLuv as
/// floats. Throws Error: kBadFile for sizes over the limits, and of a tile over its own, kUnsupported for
/// kinds of pixels and compressions that are not read. No memory is taken for pixels.
TiffLayout tiff_layout(const TiffFile& file, const ImageLimits& limits, const ImageLimits& tile_limits);

}  // namespace imgmesh
