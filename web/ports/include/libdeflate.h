// The functions of libdeflate that formats use, over a library of JavaScript (web/ports/libdeflate.cpp). They
// mean the same, but other bytes come out of the compressor.
#pragma once

#include <cstddef>
#include <cstdint>

struct libdeflate_compressor {
    int level;
};
struct libdeflate_decompressor {};

enum libdeflate_result {
    LIBDEFLATE_SUCCESS = 0,
    LIBDEFLATE_BAD_DATA = 1,
    LIBDEFLATE_SHORT_OUTPUT = 2,
    LIBDEFLATE_INSUFFICIENT_SPACE = 3,
};

libdeflate_compressor* libdeflate_alloc_compressor(int level);
void libdeflate_free_compressor(libdeflate_compressor* compressor);
std::size_t libdeflate_zlib_compress_bound(libdeflate_compressor* compressor, std::size_t size);
/// Returns 0 if the packed bytes do not fit in `room`.
std::size_t libdeflate_zlib_compress(libdeflate_compressor* compressor, const void* in, std::size_t size,
                                     void* out, std::size_t room);

libdeflate_decompressor* libdeflate_alloc_decompressor();
void libdeflate_free_decompressor(libdeflate_decompressor* decompressor);
/// `actual_size` must be null: the bytes have to give exactly `room`.
libdeflate_result libdeflate_zlib_decompress(libdeflate_decompressor* decompressor, const void* in,
                                             std::size_t size, void* out, std::size_t room,
                                             std::size_t* actual_size);

std::uint32_t libdeflate_adler32(std::uint32_t adler, const void* bytes, std::size_t size);
std::uint32_t libdeflate_crc32(std::uint32_t crc, const void* bytes, std::size_t size);
