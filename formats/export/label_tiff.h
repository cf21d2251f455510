// Labels as a TIFF of 32-bit integers, of any size.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "libcore/base/types.h"

namespace imgmesh {

/// Writes a grey TIFF with one unsigned 32-bit label a pixel, in strips packed by deflate; a BigTIFF where 4
/// GB may not be enough. GDAL's tag names kNone as the value that is no data. Holds one strip. Same bytes for
/// the same labels.
class LabelTiff {
  public:
    /// The file appears at commit(). Throws Error(kIo) if it cannot be written, or if it exists and
    /// `overwrite` is false.
    LabelTiff(const std::string& path, int width, int height, bool overwrite);
    ~LabelTiff();
    LabelTiff(const LabelTiff&) = delete;
    LabelTiff& operator=(const LabelTiff&) = delete;

    /// Adds whole rows below those already there: a multiple of the width. Throws Error(kIo).
    void put(std::span<const Id> labels);
    /// After the last row. Throws Error(kIo).
    void commit();

  private:
    class File;
    std::unique_ptr<File> file_;
};

}  // namespace imgmesh
