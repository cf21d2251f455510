// A file on disk of which parts are read.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace imgmesh {

/// A regular file, open for reading at any place by several threads at once. Nothing of it is mapped or kept,
/// so that limits of memory count only what is asked for, and a file that shrinks ends early.
class RandomFile {
  public:
    /// Knows the names of StreamFiles. Throws Error(kIo) if the file cannot be opened or is no regular file.
    explicit RandomFile(const std::string& path);
    ~RandomFile();
    RandomFile(const RandomFile&) = delete;
    RandomFile& operator=(const RandomFile&) = delete;

    const std::string& path() const { return path_; }
    std::uint64_t size() const { return size_; }  ///< when it was opened [bytes]

    /// Reads the bytes from `at` on. Returns how many there were: fewer than `out` holds only at the end.
    /// Throws Error(kIo) if the system cannot read it.
    std::size_t read_at(std::uint64_t at, std::span<std::uint8_t> out) const;
    /// Returns the bytes from `at` on, at most `most`.
    std::vector<std::uint8_t> bytes_at(std::uint64_t at, std::size_t most) const;

  private:
    std::string path_;
    int fd_;
    std::uint64_t size_ = 0;
};

}  // namespace imgmesh
