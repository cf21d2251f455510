// Writes rows as a tiled BigTIFF without compression. Internal to this room.
#pragma once

#include <tiffio.h>

#include <cstdarg>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/files/atomic_file.h"
#include "libcore/base/error.h"

namespace imgmesh {

/// What lies in the rows.
struct RowShape {
    int width = 0, height = 0;
    int samples = 1;      ///< of a pixel
    int bits = 8;         ///< of a sample
    bool planar = false;  ///< each sample has rows of its own

    int pixel_bits() const { return planar ? bits : samples * bits; }
    std::size_t row_bytes() const {
        return (static_cast<std::size_t>(width) * static_cast<std::size_t>(pixel_bits()) + 7) / 8;
    }
};

/// Holds a row of tiles: 32 MiB, or 16 rows if they are longer.
class TiledRows {
  public:
    /// `set_tags` sets what is not in the shape. Throws Error(kIo).
    TiledRows(const std::string& path, const RowShape& shape, const std::function<void(TIFF*)>& set_tags);

    /// Writes the next plane: read(y, row) gives its rows from the top, and returns false for one that the
    /// original has broken. Then the row's tiles are left out. Throws Error(kIo).
    void write_plane(const std::function<bool(int, std::span<std::uint8_t>)>& read);
    bool empty() const { return empty_; }  ///< all tiles are left out
    /// Gives the file its name. Throws Error(kIo).
    void finish();

  private:
    struct Close {
        void operator()(TIFF* tiff) const { TIFFClose(tiff); }
    };

    static int on_error(TIFF*, void* self, const char*, const char*, std::va_list);
    Error failed() const;
    void write_tiles(int rows, bool sound);

    std::string path_;
    RowShape shape_;
    AtomicFile file_;
    std::string error_;
    std::unique_ptr<TIFF, Close> tiff_;
    int tile_height_ = 0;
    bool empty_ = true;
    std::uint32_t index_ = 0;
    std::vector<std::uint8_t> rows_;
};

}  // namespace imgmesh
