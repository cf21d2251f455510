// The pixels of a tile: cut out of the picture and of its mask.
#pragma once

#include <functional>
#include <memory>

#include "formats/picture/image_io.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/pipeline/build_source.h"
#include "libcore/tiles/tile_mask.h"

namespace imgmesh {

class RegionSource;
struct PictureFacts;

/// Part of a picture, and which of its pixels are meshed.
struct PixelPart {
    Image image;
    Mask mask;  ///< empty() for all of them; may have none inside
};

/// A tile of level 0.
struct TilePart {
    Image image;
    TileMask mask;
};

/// What of the pixels counts.
struct MaskChoice {
    AlphaUse alpha = AlphaUse::kIgnore;  ///< kCut, kKeep or kIgnore
    double threshold = 0.5;              ///< of alpha, or of a mask's brightness
};

/// A picture of any size and perhaps the picture of its mask.
class TilePixels {
  public:
    /// picture  a file or a list of files (RegionSource), or a copy that can be read by parts
    /// mask     a picture of the same size, or ""
    TilePixels(const std::string& picture, const std::string& mask, const ReadImageOptions& read);
    ~TilePixels();

    const PictureFacts& facts() const;
    /// As RegionSource::sweep().
    void sweep(const std::function<bool(const PixelRect&)>& look) const;
    /// Pixels outside of the mask, by alpha or without data, are outside of the part's mask.
    PixelPart read(const PixelRect& rect, const MaskChoice& choice) const;
    /// Reads a tile of level 0. Where the pixels around it cannot be read, those at its sides stand for them.
    TilePart read_tile(const TileGrid& grid, const TileName& tile, const MaskChoice& choice) const;

  private:
    std::unique_ptr<RegionSource> picture_, mask_;
};

}  // namespace imgmesh
