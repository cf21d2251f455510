// The samples of an EXR's part, of the chunks of lines or the tiles that are touched. Internal to this
// folder.
#pragma once

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfMultiPartInputFile.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "formats/picture/decode/exr_choice.h"
#include "libcore/image/image.h"

namespace imgmesh {

/// What of a part lies in one piece in the file: some lines, or a tile.
struct ExrBlock {
    bool tile = false;
    std::int64_t width = 0, height = 0;  ///< as the header has them; the last one may have fewer lines
    std::int64_t channels = 0;           ///< all of the file's, as OpenEXR holds them
    std::int64_t bytes = 0;              ///< without compression
};
ExrBlock exr_block(const Imf::Header& header);

/// Reads level 0. One thread at a time; what it refers to must outlive it.
class ExrSamples {
  public:
    ExrSamples(Imf::MultiPartInputFile& file, const ExrChoice& choice);
    ~ExrSamples();
    ExrSamples(const ExrSamples&) = delete;
    ExrSamples& operator=(const ExrSamples&) = delete;

    /// Reads all blocks that have pixels of `wanted`, which is inside the data window, and puts those that
    /// `image` has into it; `origin` is its first pixel. Both count as the file does. Returns for each
    /// channel whether all its numbers are floats exactly. Throws what OpenEXR throws for broken blocks.
    std::vector<char> read(const Imath::Box2i& wanted, const Imath::V2i& origin, Image& image);

  private:
    struct Blocks;
    struct Lines;
    struct Tiles;

    const ExrChoice& choice_;
    std::unique_ptr<Blocks> blocks_;
};

}  // namespace imgmesh
