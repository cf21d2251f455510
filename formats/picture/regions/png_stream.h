// A PNG file read from its start to its end, without holding it. Internal to this room.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "formats/files/random_file.h"
#include "formats/picture/decode/inflater.h"
#include "formats/picture/decode/png_chunks.h"
#include "libcore/base/error.h"

namespace imgmesh {

/// The chunks beside the pixels, and where the pixels lie.
class PngHead {
  public:
    /// Throws Error: kBadFile and kUnsupported as png_parts() does; kBadFile for more than 64 MiB beside the
    /// pixels. `file` must outlive it.
    explicit PngHead(const RandomFile& file);

    /// Its `pixels` are empty.
    const PngParts& parts() const { return parts_; }
    struct Piece {
        std::uint64_t at, size;
        bool cut;  ///< by the end of the file
    };
    const std::vector<Piece>& pieces() const { return pieces_; }

  private:
    std::vector<std::uint8_t> bytes_;  ///< the file without its pixels
    std::vector<Piece> pieces_;
    PngParts parts_;
};

/// Unpacks the pixels of a PNG.
class PngStream {
  public:
    /// Both must outlive it.
    PngStream(const RandomFile& file, const PngHead& head);
    PngStream(const PngStream&) = delete;
    PngStream& operator=(const PngStream&) = delete;

    /// Fills `out`. Throws Error(kBadFile) for pixels that do not unpack or end too early.
    void read(std::span<std::uint8_t> out);
    /// After the pixels: throws Error(kBadFile) if both of their checksums are wrong; returns a warning for
    /// one, and for more pixels than were asked for.
    std::vector<std::string> finish();

  private:
    Error broken(const std::string& what) const;
    bool next_bytes();
    std::size_t unpack(std::span<std::uint8_t> out);

    const RandomFile& file_;
    const PngHead& head_;
    Inflater inflater_{Inflater::Frame::kRaw};  ///< without zlib's checks, of which one may fail
    std::vector<std::uint8_t> packed_;
    std::size_t piece_ = 0;       ///< the one that is read
    std::uint64_t in_piece_ = 0;  ///< bytes of it that have been
    std::uint32_t crc_ = 0;
    std::uint32_t adler_ = 1;
    bool pieces_checked_ = true;
    bool ended_ = false;  ///< the stream has
};

}  // namespace imgmesh
