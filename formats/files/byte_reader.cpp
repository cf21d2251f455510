#include "formats/files/byte_reader.h"

#include <algorithm>
#include <cassert>

namespace imgmesh {

std::span<const std::uint8_t> ByteReader::take(std::size_t count) {
    if (count > left()) throw EndOfBytes{position()};
    at_ += count;
    return bytes_.subspan(at_ - count, count);
}

std::uint32_t ByteReader::number(int count) {
    return combined(take(static_cast<std::size_t>(count)));
}

bool ByteReader::take_if(std::uint8_t byte) {
    if (left() == 0) throw EndOfBytes{position()};
    if (bytes_[at_] != byte) return false;
    ++at_;
    return true;
}

std::optional<std::string_view> ByteReader::terminated_text(std::size_t most) {
    const auto rest = bytes_.subspan(at_);
    const auto search = rest.first(most < rest.size() ? most + 1 : rest.size());
    const auto end = std::ranges::find(search, 0);
    if (end == search.end()) return std::nullopt;
    const auto length = static_cast<std::size_t>(end - search.begin());
    at_ += length + 1;
    return text_of(rest.first(length));
}

std::uint32_t ByteReader::number_at(std::size_t position, int count) const {
    const auto size = static_cast<std::size_t>(count);
    return has(position, size) ? combined(bytes_.subspan(position - start_, size)) : 0;
}

bool ByteReader::has_at(std::size_t position, std::string_view text) const {
    return has(position, text.size()) && text_of(bytes_.subspan(position - start_, text.size())) == text;
}

std::uint32_t ByteReader::combined(std::span<const std::uint8_t> bytes) const {
    assert(bytes.size() <= 4);
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
        value = value << 8 | bytes[order_ == ByteOrder::kBig ? i : bytes.size() - 1 - i];
    return value;
}

bool ByteReader::has(std::size_t position, std::size_t count) const {
    return position >= start_ && position - start_ <= bytes_.size() &&
           count <= bytes_.size() - (position - start_);
}

}  // namespace imgmesh
