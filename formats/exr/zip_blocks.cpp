#include "formats/exr/zip_blocks.h"

#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace imgmesh {
namespace {

// docs/decisions/0016-fast-files.md: slower levels shrink pixel maps by a percent or two, faster ones save no
// time.
constexpr int kLevel = 4;

using Byte16 = std::uint8_t __attribute__((vector_size(16)));

// bytes[i] becomes the sum of bytes[0 ... i], minus 128 for each except the first. It works on sixteen bytes
// at a time: in a vector, sums of 2, 4, 8 and 16 neighbours in turn.
void add_up(std::span<std::uint8_t> bytes) {
    constexpr Byte16 kZero = {};
    std::uint8_t sum = 128;
    std::size_t i = 0;
    for (; i + 16 <= bytes.size(); i += 16) {
        Byte16 v;
        std::memcpy(&v, bytes.data() + i, sizeof v);
        v -= 128;
        v += __builtin_shufflevector(kZero, v, 0, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30);
        v += __builtin_shufflevector(kZero, v, 0, 1, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29);
        v += __builtin_shufflevector(kZero, v, 0, 1, 2, 3, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27);
        v += __builtin_shufflevector(kZero, v, 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23);
        v += sum;
        std::memcpy(bytes.data() + i, &v, sizeof v);
        sum = v[15];
    }
    for (; i < bytes.size(); ++i) bytes[i] = sum = static_cast<std::uint8_t>(bytes[i] + sum - 128);
}

// Writes every other byte, from `first` on, less the one before of these, plus 128; the first as it is.
// Returns how many they are.
std::size_t differences(std::span<const std::uint8_t> bytes, std::size_t first, std::uint8_t* out) {
    const std::size_t count = (bytes.size() + 1 - first) / 2;
    if (count == 0) return 0;
    const std::uint8_t* const from = bytes.data() + first;
    out[0] = from[0];
    for (std::size_t i = 1; i < count; ++i)
        out[i] = static_cast<std::uint8_t>(from[2 * i] - from[2 * i - 2] + 128);
    return count;
}

}  // namespace

ZipPacker::ZipPacker() : deflate_(libdeflate_alloc_compressor(kLevel)) {
    if (!deflate_) throw std::bad_alloc();
}
ZipPacker::~ZipPacker() {
    libdeflate_free_compressor(deflate_);
}

std::vector<std::uint8_t> ZipPacker::pack(std::span<const std::uint8_t> samples) {
    const std::size_t size = samples.size();
    sorted_.resize(size);
    const std::size_t evens = differences(samples, 0, sorted_.data());
    differences(samples, 1, sorted_.data() + evens);
    // Where the odd bytes begin, the last of the even ones is the one before.
    if (size > 1) sorted_[evens] = static_cast<std::uint8_t>(samples[1] - samples[(size - 1) / 2 * 2] + 128);
    // Without room for that many bytes it gives up at once.
    std::vector<std::uint8_t> packed(size);
    const std::size_t length =
        size < 2 ? 0 : libdeflate_zlib_compress(deflate_, sorted_.data(), size, packed.data(), size - 1);
    if (length == 0) return {samples.begin(), samples.end()};
    packed.resize(length);
    return packed;
}

ZipUnpacker::ZipUnpacker() : inflate_(libdeflate_alloc_decompressor()) {
    if (!inflate_) throw std::bad_alloc();
}
ZipUnpacker::~ZipUnpacker() {
    libdeflate_free_decompressor(inflate_);
}

bool ZipUnpacker::unpack(std::span<const std::uint8_t> packed, std::span<std::uint8_t> samples) {
    const std::size_t size = samples.size(), evens = (size + 1) / 2;
    if (packed.size() == size) {
        std::ranges::copy(packed, samples.begin());
        return true;
    }
    sorted_.resize(size);
    // Fails if the bytes give fewer or more than `size`.
    if (libdeflate_zlib_decompress(inflate_, packed.data(), packed.size(), sorted_.data(), size, nullptr) !=
        LIBDEFLATE_SUCCESS)
        return false;
    add_up(sorted_);
    for (std::size_t i = 0; i < size / 2; ++i) {
        samples[2 * i] = sorted_[i];
        samples[2 * i + 1] = sorted_[evens + i];
    }
    if (size % 2) samples[size - 1] = sorted_[evens - 1];
    return true;
}

}  // namespace imgmesh
