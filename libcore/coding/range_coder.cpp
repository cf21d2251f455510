#include "libcore/coding/range_coder.h"

#include <utility>

namespace imgmesh::coding {

// low_ has 32 bits and a carry, which goes into the bytes that are already out.
void RangeEncoder::shift_out() {
    if (low_ >> 32 != 0)
        for (std::size_t i = bytes_.size(); i-- > 0 && ++bytes_[i] == 0;) {
        }
    bytes_.push_back(static_cast<std::uint8_t>(low_ >> 24));
    low_ = (low_ & 0x00FFFFFF) << 8;
}

// Any number in [low_, low_ + range_) will do: the one that differs from the bytes after the end in the
// fewest.
std::vector<std::uint8_t> RangeEncoder::finish() {
    const std::uint64_t last = low_ + range_ - 1;
    int kept = 4;
    for (int bytes = 0; bytes < 4; ++bytes) {
        const int rest = 32 - 8 * bytes;
        const std::uint64_t tail = kAfterEnd & ((std::uint64_t{1} << rest) - 1);
        std::uint64_t value = (last >> rest << rest) + tail;
        if (value > last) value -= std::uint64_t{1} << rest;
        if (value < low_ || value > last) continue;
        low_ = value;
        kept = bytes;
        break;
    }
    for (int i = 0; i < 4; ++i) shift_out();
    bytes_.resize(bytes_.size() - static_cast<std::size_t>(4 - kept));
    return std::move(bytes_);
}

}  // namespace imgmesh::coding
