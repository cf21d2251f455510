// An EXR file of scanlines that is written to memory. Private to this folder and web/ports; the page has
// another half (web/ports/exr_output.cpp).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "formats/exr/exr_part_header.h"

namespace imgmesh {

/// All functions throw Error(kInternal).
class ExrOutput {
  public:
    /// The file grows in `bytes`, which must outlive it.
    explicit ExrOutput(std::vector<std::uint8_t>& bytes);
    ~ExrOutput();
    ExrOutput(const ExrOutput&) = delete;
    ExrOutput& operator=(const ExrOutput&) = delete;

    /// Adds a part of scanlines with a name, before the first block of any.
    void add_part(const ExrPartHeader& part);
    /// Appends a block of kExrZipRows rows or those that are left, as it is packed, by its first row of the
    /// data window. The blocks of a part come in order, after those of the parts before.
    void write_block(std::size_t part, int row, std::span<const std::uint8_t> packed);
    /// Writes the tables of blocks.
    void finish();

  private:
    class File;
    std::unique_ptr<File> file_;
};

}  // namespace imgmesh
