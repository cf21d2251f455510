// Sources: RFC 1950 (zlib), ISO 3309 (CRC-32). The packing itself is fflate's.
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "web/ports/script_libraries.h"

namespace {

std::span<const std::uint8_t> bytes_of(const void* bytes, std::size_t size) {
    return {static_cast<const std::uint8_t*>(bytes), size};
}

}  // namespace

libdeflate_compressor* libdeflate_alloc_compressor(int level) {
    return new libdeflate_compressor{level};
}

void libdeflate_free_compressor(libdeflate_compressor* compressor) {
    delete compressor;
}

// Stored blocks have five bytes beside 64 kB, and there are six bytes around all.
std::size_t libdeflate_zlib_compress_bound(libdeflate_compressor*, std::size_t size) {
    return size + size / 4096 + 64;
}

std::size_t libdeflate_zlib_compress(libdeflate_compressor* compressor, const void* in, std::size_t size,
                                     void* out, std::size_t room) {
    const emscripten::val packed = imgmesh::web::script_library("zlib").call<emscripten::val>(
        "pack", imgmesh::web::view_of(bytes_of(in, size)), compressor->level);
    const auto length = packed["length"].as<std::size_t>();
    if (length > room) return 0;
    imgmesh::web::copy_from_script(packed, std::span(static_cast<std::uint8_t*>(out), room));
    return length;
}

libdeflate_decompressor* libdeflate_alloc_decompressor() {
    return new libdeflate_decompressor;
}

void libdeflate_free_decompressor(libdeflate_decompressor* decompressor) {
    delete decompressor;
}

libdeflate_result libdeflate_zlib_decompress(libdeflate_decompressor*, const void* in, std::size_t size,
                                             void* out, std::size_t room,
                                             [[maybe_unused]] std::size_t* actual_size) {
    assert(!actual_size);
    constexpr std::size_t kAround = 6;
    if (size < kAround) return LIBDEFLATE_BAD_DATA;
    const emscripten::val bytes = imgmesh::web::script_library("zlib").call<emscripten::val>(
        "unpack", imgmesh::web::view_of(bytes_of(in, size)), room);
    if (bytes.isNull()) return LIBDEFLATE_BAD_DATA;
    imgmesh::web::copy_from_script(bytes, std::span(static_cast<std::uint8_t*>(out), room));
    const std::uint8_t* const stored = static_cast<const std::uint8_t*>(in) + size - 4;
    std::uint32_t adler = 0;
    for (int i = 0; i < 4; ++i) adler = adler << 8 | stored[i];
    return adler == libdeflate_adler32(1, out, room) ? LIBDEFLATE_SUCCESS : LIBDEFLATE_BAD_DATA;
}

std::uint32_t libdeflate_adler32(std::uint32_t adler, const void* bytes, std::size_t size) {
    constexpr std::uint32_t kModulus = 65521;
    constexpr std::size_t kPiece = 5552;  // the sums fit in 32 bits so long
    std::uint32_t a = adler & 0xFFFF, b = adler >> 16;
    auto left = bytes_of(bytes, size);
    while (!left.empty()) {
        const auto piece = left.first(std::min(left.size(), kPiece));
        for (const std::uint8_t byte : piece) b += a += byte;
        a %= kModulus;
        b %= kModulus;
        left = left.subspan(piece.size());
    }
    return b << 16 | a;
}

std::uint32_t libdeflate_crc32(std::uint32_t crc, const void* bytes, std::size_t size) {
    constexpr auto kTable = [] {
        std::array<std::uint32_t, 256> table{};
        for (std::uint32_t i = 0; i < 256; ++i) {
            table[i] = i;
            for (int k = 0; k < 8; ++k) table[i] = table[i] & 1 ? 0xEDB88320u ^ table[i] >> 1 : table[i] >> 1;
        }
        return table;
    }();
    crc = ~crc;
    for (const std::uint8_t byte : bytes_of(bytes, size)) crc = kTable[(crc ^ byte) & 0xFF] ^ crc >> 8;
    return ~crc;
}
