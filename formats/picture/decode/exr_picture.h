// The image of an EXR file, whole or in parts. Internal to this room.
#pragma once

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMultiPartInputFile.h>

#include <memory>
#include <string>

#include "formats/picture/decode/exr_choice.h"
#include "formats/picture/decode/exr_samples.h"
#include "formats/picture/decode/picture_decoders.h"

namespace imgmesh {

/// The part, layer and channels of the options. What it refers to must outlive it. One thread at a time.
class ExrPicture {
  public:
    /// The headers have passed make_attributes_opaque(). `limits` are those of the image; of one tile those
    /// of the options count. Throws Error as decode_exr() does; no block has been looked at.
    ExrPicture(const std::string& path, Imf::IStream& stream, const ReadImageOptions& options,
               const ImageLimits& limits);

    int width() const { return shown_.max.x - shown_.min.x + 1; }  ///< of the display window
    int height() const { return shown_.max.y - shown_.min.y + 1; }
    const Imf::MultiPartInputFile& file() const { return *file_; }
    Imf::MultiPartInputFile& file() { return *file_; }
    int part() const { return choice_.part; }
    const Imf::Header& header() const { return file_->header(choice_.part); }
    const std::vector<ExrChannel>& channels() const { return choice_.channels; }
    const ExrBlock& block() const { return block_; }
    std::int64_t block_count() const;

    /// Reads the pixels of `area`, which is inside the image, of the blocks that it touches. Throws
    /// Error(kBadFile) for blocks that are broken or missing.
    DecodedPicture read(const PixelRect& area);
    /// Reads all pixels; also blocks that are not shown must be sound.
    DecodedPicture read_all();
    /// What read() gives for a pixel of zeros, without looking at the file's: all that pixels do not change.
    DecodedPicture zero_pixel() const;

  private:
    DecodedPicture read_blocks(const PixelRect& area, const Imath::Box2i& wanted);

    const std::string& path_;
    const ReadImageOptions& options_;
    std::unique_ptr<Imf::MultiPartInputFile> file_;
    ExrChoice choice_;
    Imath::Box2i shown_, stored_;
    ExrBlock block_;
    std::unique_ptr<ExrSamples> samples_;  ///< from the first block on: it holds one
};

}  // namespace imgmesh
