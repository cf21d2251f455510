// Reads numbers and pieces from the bytes of a file of any origin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace imgmesh {

enum class ByteOrder { kBig, kLittle };

/// Thrown if the bytes end too early. Each format translates it into its own error.
struct EndOfBytes {
    std::size_t position;  ///< where the missing piece starts, as of ByteReader::position()
};

/// Steps through bytes. The pieces that it returns are views of the bytes; it never reads beyond them.
class ByteReader {
  public:
    /// `start` is the position of the first byte, if the bytes are a part of a file.
    ByteReader(std::span<const std::uint8_t> bytes, ByteOrder order, std::size_t start = 0)
        : bytes_(bytes), order_(order), start_(start) {}

    std::size_t position() const { return start_ + at_; }
    std::size_t left() const { return bytes_.size() - at_; }

    /// Takes the next `count` bytes. Throws EndOfBytes, as the next two do, and then stays where it is.
    std::span<const std::uint8_t> take(std::size_t count);
    /// Takes an unsigned number of 1 to 4 bytes.
    std::uint32_t number(int count);
    /// Returns whether the next byte is this one, and steps over it if so.
    bool take_if(std::uint8_t byte);
    /// Takes the text up to the next zero byte and steps over both. Returns nothing, without a step, if there
    /// is no zero after at most `most` other bytes.
    std::optional<std::string_view> terminated_text(std::size_t most);

    /// Returns the number at any position; 0 if it is not complete.
    std::uint32_t number_at(std::size_t position, int count) const;
    /// Returns whether this text is at a position.
    bool has_at(std::size_t position, std::string_view text) const;

  private:
    std::uint32_t combined(std::span<const std::uint8_t> bytes) const;
    bool has(std::size_t position, std::size_t count) const;

    std::span<const std::uint8_t> bytes_;
    ByteOrder order_;
    std::size_t start_;
    std::size_t at_ = 0;
};

/// Returns bytes as characters.
inline std::string_view text_of(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace imgmesh
