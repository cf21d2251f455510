// A TIFF of any size, written block by block.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "libcore/image/image.h"

namespace imgmesh {

/// What is known of a picture before its pixels.
struct PictureShape : GridSize {
    int channels = 3;  ///< of make_image(): Y, Y A, R G B or R G B A
    SampleType sample_type = SampleType::kUint8;
    ColorSpace color_space = ColorSpace::kSrgb;
};

/// Writes a tiled TIFF with deflate, a BigTIFF where 4 GB may not be enough. Rows that are not yet complete
/// are held as they are stored. The same blocks give the same bytes.
class TiledTiff {
  public:
    /// Throws Error: kBadArgument for a sample type that TIFF does not hold; kIo if it cannot be written.
    TiledTiff(const std::string& path, const PictureShape& shape, std::optional<SampleType> sample_type,
              bool overwrite);
    ~TiledTiff();
    TiledTiff(const TiledTiff&) = delete;
    TiledTiff& operator=(const TiledTiff&) = delete;

    /// Puts a block of the shape's channels, sample type and colour space at (x, y), in rows that are not
    /// complete. Pixels never put are 0.
    void put(int x, int y, const Image& block);
    /// The rows above `bottom` are complete. Throws Error(kIo).
    void complete(int bottom);
    /// After complete() of all rows: gives the file its name. Throws Error(kIo).
    void commit();

  private:
    struct Target;
    class File;
    std::unique_ptr<File> file_;
};

}  // namespace imgmesh
