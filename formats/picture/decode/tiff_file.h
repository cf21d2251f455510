// A TIFF file in memory or on disk, opened by libtiff.
#pragma once

#include <tiffio.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/files/random_file.h"
#include "libcore/base/error.h"

namespace imgmesh {

/// What libtiff may take at once [bytes]. Bytes are in memory already, and a block is at most as large as our
/// own buffer for it. No table of a sound file comes near this.
inline constexpr std::uint64_t kMostAtOnce = std::uint64_t{1} << 30;

/// Handlers for errors and warnings belong to this file alone, so that files can be read side by side.
class TiffFile {
  public:
    /// Reads the first directory. `path` and `bytes` must outlive the file. Throws Error(kBadFile).
    TiffFile(const std::string& path, std::span<const std::uint8_t> bytes);
    /// The same of a file on disk. Of its table of blocks only what is asked for is read.
    explicit TiffFile(const RandomFile& file);
    TiffFile(const TiffFile&) = delete;
    TiffFile& operator=(const TiffFile&) = delete;
    ~TiffFile() = default;

    TIFF* get() const { return tiff_.get(); }
    const std::string& path() const { return path_; }
    std::uint64_t size() const { return file_ ? file_->size() : bytes_.size(); }  ///< bytes
    /// Returns the bytes from `at` on, at most `most`.
    std::vector<std::uint8_t> bytes_at(std::uint64_t at, std::size_t most) const;

    /// The tag's value; `otherwise` if the file does not have it.
    template <typename Value>
    Value tag(ttag_t name, Value otherwise) const {
        Value value{};
        return TIFFGetField(tiff_.get(), name, &value) == 1 ? value : otherwise;
    }
    /// The same with the standard's own defaults.
    template <typename Value>
    Value defaulted_tag(ttag_t name, Value otherwise) const {
        Value value{};
        return TIFFGetFieldDefaulted(tiff_.get(), name, &value) == 1 ? value : otherwise;
    }

    /// Forgets what the library has said until now; most of it is about tags that nobody needs.
    void forget_messages();
    const std::vector<std::string>& warnings() const { return warnings_; }

    Error broken(const std::string& what) const;       ///< kBadFile, with the library's first reason
    Error unsupported(const std::string& what) const;  ///< kUnsupported

  private:
    struct Close {
        void operator()(TIFF* tiff) const { TIFFClose(tiff); }
    };
    struct Callbacks;

    void open(const char* mode);
    std::size_t read_at(std::uint64_t at, std::span<std::uint8_t> out) const;

    const std::string& path_;
    std::span<const std::uint8_t> bytes_ = {};
    const RandomFile* file_ = nullptr;
    std::uint64_t at_ = 0;
    std::string error_;  ///< the first
    std::vector<std::string> warnings_;
    std::unique_ptr<TIFF, Close> tiff_;  ///< last: it is closed before what its handlers use
};

}  // namespace imgmesh
