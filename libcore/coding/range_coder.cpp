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

// Any number in [low_, low_ + range_) will do: the one with the most zero bits at its end.
std::vector<std::uint8_t> RangeEncoder::finish() {
    const std::uint64_t last = low_ + range_ - 1;
    for (int zeros = 32; zeros >= 0; --zeros) {
        const std::uint64_t value = last >> zeros << zeros;
        if (value < low_) continue;
        low_ = value;
        break;
    }
    for (int i = 0; i < 4; ++i) shift_out();
    for (int i = 0; i < 4 && bytes_.back() == 0; ++i) bytes_.pop_back();
    return std::move(bytes_);
}

}  // namespace imgmesh::coding
