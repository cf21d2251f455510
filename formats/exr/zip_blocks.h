// EXR's ZIP compression of a block of scanlines, by libdeflate.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

struct libdeflate_compressor;
struct libdeflate_decompressor;

namespace imgmesh {

/// Packs one block after the other. Two threads must not use one object at a time. Source: "OpenEXR File
/// Layout" and Technical Introduction: bytes at even places come before those at odd ones, each as its
/// difference from the one before, deflated.
class ZipPacker {
  public:
    ZipPacker();
    ~ZipPacker();
    ZipPacker(const ZipPacker&) = delete;
    ZipPacker& operator=(const ZipPacker&) = delete;

    /// Returns what the file holds for the block: `samples` themselves if they do not shrink. The same
    /// samples give the same bytes.
    std::vector<std::uint8_t> pack(std::span<const std::uint8_t> samples);

  private:
    libdeflate_compressor* deflate_;
    std::vector<std::uint8_t> sorted_;
};

/// The inverse.
class ZipUnpacker {
  public:
    ZipUnpacker();
    ~ZipUnpacker();
    ZipUnpacker(const ZipUnpacker&) = delete;
    ZipUnpacker& operator=(const ZipUnpacker&) = delete;

    /// Fills `samples`; returns false if `packed` does not give exactly that many. Safe for any bytes.
    bool unpack(std::span<const std::uint8_t> packed, std::span<std::uint8_t> samples);

  private:
    libdeflate_decompressor* inflate_;
    std::vector<std::uint8_t> sorted_;
};

}  // namespace imgmesh
