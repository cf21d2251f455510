// Pictures of any size, read by parts: what read_image() would give, cut out. Target imgmesh::pictures.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/picture/image_io.h"
#include "libcore/image/image.h"

namespace imgmesh {

/// How parts of a picture are read.
enum class RegionAccess {
    kDirect,  ///< from the blocks that they touch
    kSpool,   ///< better after spool_picture() has rewritten it; until then much is read for each part
    kWhole    ///< the whole picture is held, which ReadImageOptions::limits bound
};

/// What a picture is, without its pixels.
struct PictureFacts {
    int width = 0, height = 0;  ///< as displayed
    std::vector<std::string> channel_names;
    SampleType sample_type = SampleType::kUint8;
    RegionAccess access = RegionAccess::kWhole;
    std::string why;  ///< not kDirect: one clause, as in "it is a PNG"
    bool holds_all =
        false;  ///< the whole picture is held, or may be where parts are not read from the top on
    int block_width = 0, block_height = 0;   ///< as stored [pixels]; 0 for kWhole
    bool fits_colors = false;                ///< RegionSource::color_space() has to look at all pixels
    std::vector<std::string> warnings = {};  ///< each one sentence without the file's name
};

/// A picture of at most 1,000,000 pixels a side that is read by rectangles. Each gives the samples, to the
/// bit, that read_image() of the whole picture has there. Can be used by several threads at once.
///
/// Options count as for read_image(), but their limits of pixels, sides and memory hold for a region, and for
/// the whole picture only where it is held; ImageLimits::max_pixels_per_byte holds for the whole file.
/// NonFinite::kNearest is refused, as the nearest pixel may lie outside of a region.
class RegionSource {
  public:
    /// Opens a picture file, or a list of such (docs/images.md, "Huge pictures"), and reads what it says
    /// about itself. Throws as read_image_file() does; Error(kBadArgument) for kNearest.
    explicit RegionSource(const std::string& path, const ReadImageOptions& options = {});
    ~RegionSource();
    RegionSource(const RegionSource&) = delete;
    RegionSource& operator=(const RegionSource&) = delete;

    const PictureFacts& facts() const;

    /// The space of the colours that regions have. If facts().fits_colors, the first call reads all pixels to
    /// find the narrowest that holds them, unless options.fitting_space names it: whoever opens the picture
    /// again passes on the result there. Blocks that are broken are left out.
    ColorSpace color_space() const;

    /// Calls look(part) for rectangles of up to 4 megapixels, or a row, that cover the picture, until it
    /// returns false: what reads all pixels should do it so, as blocks that are as wide as the picture are
    /// unpacked once or twice then, and not for each tile beside each other. Where it throws Error of
    /// kBadFile or kIo, for smaller parts, down to a block, which is passed over.
    void sweep(const std::function<bool(const PixelRect&)>& look) const;

    /// Reads the pixels of `region`. Throws Error: kBadArgument for one that is empty or not inside the
    /// picture; else as read_image_file() does, naming the region, for blocks that it touches and for a file
    /// that has changed; others are not looked at.
    Image read(const PixelRect& region) const;
    /// The same with the mask of the pixels with data, and how many samples were not finite.
    ReadImage read_region(const PixelRect& region) const;

    /// What read() of a region of that size takes at most, with the result [bytes]: floats, and a few blocks
    /// as stored.
    std::uint64_t read_bytes(int width, int height) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Returns the files of which a picture consists: itself, unless it is a folder, and those that it lists, in
/// their order, whether they are there or not. Throws as the constructor of RegionSource does for lists.
std::vector<std::string> picture_files(const std::string& path, const ReadImageOptions& options = {});

}  // namespace imgmesh
