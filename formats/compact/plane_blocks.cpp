#include "formats/compact/plane_blocks.h"

#include <cstring>

#include "formats/exr/zip_blocks.h"
#include "libcore/base/index.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put_block(Bytes& out, std::span<const std::uint8_t> samples) {
    ZipPacker packer;
    const Bytes packed = packer.pack(samples);
    for (int i = 0; i < 4; ++i) out.push_back(static_cast<std::uint8_t>(packed.size() >> (8 * i)));
    out.insert(out.end(), packed.begin(), packed.end());
}

// Takes a block with its length. Nothing of it is unpacked if `samples` is empty.
bool take_block(std::span<const std::uint8_t>& bytes, std::span<std::uint8_t> samples) {
    if (bytes.size() < 4) return false;
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length |= std::size_t{bytes[i]} << (8 * i);
    if (length > bytes.size() - 4) return false;
    const std::span<const std::uint8_t> packed = bytes.subspan(4, length);
    bytes = bytes.subspan(4 + length);
    if (samples.empty()) return true;
    ZipUnpacker unpacker;
    return unpacker.unpack(packed, samples);
}

std::size_t row_bytes_of(int width) {
    return (as_index(width) + 7) / 8;
}

}  // namespace

void put_mask(Bytes& out, std::span<const std::uint8_t> inside, int width) {
    const std::size_t columns = as_index(width), rows = inside.size() / columns,
                      row_bytes = row_bytes_of(width);
    Bytes bits(rows * row_bytes);
    for (std::size_t y = 0; y < rows; ++y)
        for (std::size_t x = 0; x < columns; ++x) {
            const std::size_t i = y * columns + x;
            const bool above = y > 0 && inside[i - columns] != 0;
            bits[y * row_bytes + x / 8] |= static_cast<std::uint8_t>((above != (inside[i] != 0)) << (x % 8));
        }
    put_block(out, bits);
}

bool take_mask(std::span<const std::uint8_t>& bytes, std::span<std::uint8_t> inside, int width) {
    const std::size_t columns = as_index(width), rows = inside.size() / columns,
                      row_bytes = row_bytes_of(width);
    Bytes bits(rows * row_bytes);
    if (!take_block(bytes, bits)) return false;
    for (std::size_t y = 0; y < rows; ++y)
        for (std::size_t x = 0; x < columns; ++x) {
            const std::size_t i = y * columns + x;
            const unsigned above = y > 0 ? inside[i - columns] : 0u,
                           bit = bits[y * row_bytes + x / 8] >> (x % 8);
            inside[i] = static_cast<std::uint8_t>((above ^ bit) & 1);
        }
    return true;
}

void put_visits(Bytes& out, std::span<const Id> visits) {
    Bytes samples(visits.size_bytes());
    std::memcpy(samples.data(), visits.data(), samples.size());
    put_block(out, samples);
}

bool take_visits(std::span<const std::uint8_t>& bytes, std::span<Id> visits) {
    Bytes samples(visits.size_bytes());
    if (!take_block(bytes, samples)) return false;
    if (!visits.empty()) std::memcpy(visits.data(), samples.data(), samples.size());
    return true;
}

}  // namespace imgmesh
