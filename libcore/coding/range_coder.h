// Binary range coding in memory (Martin 1979; carries as in LZMA's coder). Encoder, decoder and a counter of
// bits have one interface, so that each model is written once for both directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace imgmesh::coding {

/// Probabilities of a bit that is 1 have this many bits: 1 .. 2^15 - 1.
inline constexpr int kProbabilityBits = 15;
inline constexpr std::uint32_t kRangeFloor = 1u << 24;
/// What a decoder reads after the end. A stream that was cut off goes on as if with bytes of its own, and so
/// wants more than it can have; zeros would be bits that every model soon expects.
inline constexpr std::uint32_t kAfterEnd = 0x55555555;

class RangeEncoder {
  public:
    static constexpr bool kDecodes = false;
    /// Encodes a bit whose probability of being 1 is `probability` / 2^15. Returns the bit.
    bool code(bool bit, std::uint32_t probability) {
        const std::uint32_t bound = (range_ >> kProbabilityBits) * probability;
        if (bit) {
            range_ = bound;
        } else {
            low_ += bound;
            range_ -= bound;
        }
        while (range_ < kRangeFloor) {
            range_ <<= 8;
            shift_out();
        }
        return bit;
    }
    /// Returns how many bytes are out. Up to four more are to come of what has been coded.
    std::size_t size() const { return bytes_.size(); }
    /// Returns the bytes, without those of the last four that a decoder reads after the end anyway.
    std::vector<std::uint8_t> finish();

  private:
    void shift_out();

    std::uint64_t low_ = 0;
    std::uint32_t range_ = 0xFFFFFFFF;
    std::vector<std::uint8_t> bytes_;
};

/// Writes nothing: for trials, in which models learn as the encoder's will.
struct NoCoder {
    static constexpr bool kDecodes = false;
    bool code(bool bit, std::uint32_t) { return bit; }
};

class RangeDecoder {
  public:
    static constexpr bool kDecodes = true;
    explicit RangeDecoder(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
        for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
    }
    bool code(bool, std::uint32_t probability) {
        const std::uint32_t bound = (range_ >> kProbabilityBits) * probability;
        const bool bit = code_ < bound;
        if (bit) {
            range_ = bound;
        } else {
            code_ -= bound;
            range_ -= bound;
        }
        while (range_ < kRangeFloor) {
            range_ <<= 8;
            code_ = code_ << 8 | next();
        }
        return bit;
    }
    /// Returns how many bytes were wanted beyond the end. A whole stream wants at most 4.
    std::size_t missing() const { return missing_; }
    /// Returns how many bytes were not wanted.
    std::size_t left() const { return bytes_.size() - at_; }

  private:
    std::uint32_t next() {
        if (at_ < bytes_.size()) return bytes_[at_++];
        ++missing_;
        return kAfterEnd & 0xFF;
    }

    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0, missing_ = 0;
    std::uint32_t range_ = 0xFFFFFFFF, code_ = 0;
};

}  // namespace imgmesh::coding
