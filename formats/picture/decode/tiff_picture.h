// The image of a TIFF file, whole or in parts. Internal to this room.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/decode/spool_tag.h"
#include "formats/picture/decode/tiff_layout.h"
#include "formats/picture/decode/tiff_rows.h"

namespace imgmesh {

/// GDAL's tag for the value of pixels without data, as text.
inline constexpr ttag_t kGdalNoData = 42113;

/// The first full-size page of a file. Both that and the options must outlive it. One thread at a time.
class TiffPicture {
  public:
    /// `limits` are those of the image; of one tile those of the options count. Throws Error as decode_tiff()
    /// does; no block has been looked at.
    TiffPicture(TiffFile& file, const ReadImageOptions& options, const ImageLimits& limits);

    TiffPicture(const TiffPicture&) = delete;
    TiffPicture& operator=(const TiffPicture&) = delete;
    ~TiffPicture() = default;

    const TiffLayout& layout() const { return layout_; }
    /// From now on strips are undone row by row, which has_rows() must allow.
    void read_by_rows() { rows_ = std::make_unique<TiffRows>(file_, layout_); }
    bool by_rows() const { return rows_ != nullptr; }
    /// Reads the pixels of `area`, as stored, of the blocks that it touches. Throws Error(kBadFile) for
    /// blocks that are broken or truncated.
    DecodedPicture read(const PixelRect& area);
    /// What read() gives for a pixel of zeros, without looking at the file's: all that pixels do not change.
    DecodedPicture zero_pixel();

  private:
    DecodedPicture spooled(const TiffLayout& layout, std::vector<float> samples);
    DecodedPicture picture(int width, int height, std::vector<float> samples);

    TiffFile& file_;
    const ReadImageOptions& options_;
    TiffLayout layout_;
    std::optional<double> nodata_;  ///< as the file names it
    std::optional<SpoolInfo> spool_;
    bool is_copy_ = false;  ///< by spool_tiff()
    std::vector<std::string> warnings_;
    std::unique_ptr<TiffRows> rows_;
};

}  // namespace imgmesh
