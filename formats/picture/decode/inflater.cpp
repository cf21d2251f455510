#include "formats/picture/decode/inflater.h"

#include <algorithm>
#include <new>

namespace imgmesh {

Inflater::Inflater(Frame frame) {
    if (inflateInit2(&z_, frame == Frame::kZlib ? MAX_WBITS : -MAX_WBITS) != Z_OK) throw std::bad_alloc();
}

Inflater::~Inflater() {
    inflateEnd(&z_);
}

void Inflater::restart() {
    inflateReset(&z_);
    z_.avail_in = 0;
}

void Inflater::give(std::span<std::uint8_t> packed) {
    z_.next_in = packed.data();
    z_.avail_in = static_cast<uInt>(packed.size());
}

std::uint8_t Inflater::take() {
    --z_.avail_in;
    return *z_.next_in++;
}

Inflater::Step Inflater::unpack(std::span<std::uint8_t> out) {
    const std::size_t room = std::min<std::size_t>(out.size(), std::size_t{1} << 30);
    z_.next_out = out.data();
    z_.avail_out = static_cast<uInt>(room);
    const int result = inflate(&z_, Z_NO_FLUSH);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    const State state = result == Z_STREAM_END                    ? State::kEnded
                        : result == Z_OK || result == Z_BUF_ERROR ? State::kGoesOn
                                                                  : State::kBroken;
    return {room - z_.avail_out, state};
}

}  // namespace imgmesh
