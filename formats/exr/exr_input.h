// An EXR file in memory that is read. Private to this folder; the page has another half
// (web/ports/exr_input.cpp).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "formats/exr/exr_layers.h"
#include "formats/exr/exr_part_header.h"

namespace imgmesh {

/// A part cannot be read further.
struct ExrDataError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The bytes have passed check_exr_header(), and must outlive it.
class ExrInput {
  public:
    /// Throws a std::exception if the headers are broken.
    explicit ExrInput(std::span<const std::uint8_t> bytes);
    ~ExrInput();
    ExrInput(const ExrInput&) = delete;
    ExrInput& operator=(const ExrInput&) = delete;

    const std::vector<ExrPartHeader>& parts() const { return parts_; }
    /// Returns a block of scanlines as it is packed, by its first row counted from the data window's; valid
    /// until the next call. Throws ExrDataError.
    std::span<const std::uint8_t> block(std::size_t part, int row);
    /// Fills `out`, of the size of the part's data window, from tiles. Throws ExrDataError.
    void read_tiles(std::size_t part, LayerPart& out);

  private:
    class File;
    std::unique_ptr<File> file_;
    std::vector<ExrPartHeader> parts_;
};

}  // namespace imgmesh
