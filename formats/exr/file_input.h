// A stream of OpenEXR over a file on disk.
#pragma once

#include <ImfIO.h>

#include <cstdint>
#include <vector>

#include "formats/files/random_file.h"

namespace imgmesh {

/// Reads what OpenEXR asks for, and gives it headers that make_start_opaque() has made safe. One thread at a
/// time. Reading beyond the end throws std::runtime_error, as OpenEXR expects; seeking does not.
class FileInput : public Imf::IStream {
  public:
    /// The file must outlive it. Throws Error(kBadFile) for headers that are broken or above 64 MiB.
    explicit FileInput(const RandomFile& file);

    bool read(char* out, int count) override;
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t at) override { at_ = at; }

  private:
    std::size_t copy_from(const std::vector<std::uint8_t>& bytes, std::uint64_t start, char* out,
                          std::size_t count) const;

    const RandomFile& file_;
    std::vector<std::uint8_t> headers_;
    std::vector<std::uint8_t> ahead_;  ///< from ahead_at_ on: tables are read eight bytes at a time
    std::uint64_t ahead_at_ = 0, at_ = 0;
};

}  // namespace imgmesh
