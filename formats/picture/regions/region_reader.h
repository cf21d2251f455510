// What stands behind a RegionSource. Internal to this room.
#pragma once

#include <memory>

#include "formats/picture/region_source.h"

namespace imgmesh {

/// One kind of source. Can be used by several threads at once.
class RegionReader {
  public:
    RegionReader() = default;
    virtual ~RegionReader() = default;
    RegionReader(const RegionReader&) = delete;
    RegionReader& operator=(const RegionReader&) = delete;

    virtual const PictureFacts& facts() const = 0;
    /// The space of the colours, if not facts().fits_colors.
    virtual ColorSpace color_space() const = 0;
    /// Reads a region that lies inside the picture. If facts().fits_colors, `fitting` counts for that of the
    /// options.
    virtual ReadImage read(const PixelRect& region, ColorSpace fitting) const = 0;
    virtual std::uint64_t read_bytes(int width, int height) const = 0;
};

/// One picture file, in the way that its format allows.
std::unique_ptr<RegionReader> open_picture_regions(const std::string& path, const ReadImageOptions& options);

/// A picture that is held as a whole.
std::unique_ptr<RegionReader> open_whole(const std::string& path, const ReadImageOptions& options);

}  // namespace imgmesh
