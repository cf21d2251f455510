// Numbers and pieces from the bytes of a file of any origin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace imgmesh {

enum class ByteOrder { kBig, kLittle };

/// Thrown where the bytes end before what was asked for. Each format translates it into its own error.
struct EndOfBytes {
    std::size_t position;  ///< where the missing piece starts, as of ByteReader::position()
};

/// Steps through bytes. Pieces that it hands out are views of the bytes; nothing is ever read beyond them.
class ByteReader {
  public:
    /// `start`: the position of the first byte, where the bytes are a part of a file.
    ByteReader(std::span<const std::uint8_t> bytes, ByteOrder order, std::size_t start = 0)
        : bytes_(bytes), order_(order), start_(start) {}

    std::size_t position() const { return start_ + at_; }
    std::size_t left() const { return bytes_.size() - at_; }

    /// The next `count` bytes. Throws EndOfBytes, as do the next two, and stays where it is then.
    std::span<const std::uint8_t> take(std::size_t count);
    /// An unsigned number of 1 to 4 bytes.
    std::uint32_t number(int count);
    /// Whether the next byte is this one, which is stepped over then.
    bool take_if(std::uint8_t byte);
    /// The text up to the next zero byte, which is stepped over. Nothing, and no step, where there is none
    /// behind at most `most` other bytes.
    std::optional<std::string_view> terminated_text(std::size_t most);

    /// The number at a position, wherever the reader is; 0 where it is not all there.
    std::uint32_t number_at(std::size_t position, int count) const;
    /// Whether this text stands at a position.
    bool has_at(std::size_t position, std::string_view text) const;

  private:
    std::uint32_t combined(std::span<const std::uint8_t> bytes) const;
    bool has(std::size_t position, std::size_t count) const;

    std::span<const std::uint8_t> bytes_;
    ByteOrder order_;
    std::size_t start_;
    std::size_t at_ = 0;
};

/// Bytes as the characters that they are.
inline std::string_view text_of(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace imgmesh
