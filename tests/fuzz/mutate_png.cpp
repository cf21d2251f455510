// PNG: chunks are changed inside their compression, and the checksums are made right again.
#include <libdeflate.h>

#include <algorithm>
#include <memory>
#include <string_view>

#include "formats/files/byte_reader.h"
#include "formats/files/byte_writer.h"
#include "tests/fuzz/mutate.h"

namespace imgmesh::fuzz {
namespace {

constexpr std::size_t kSignatureBytes = 8;
constexpr std::size_t kMostInflated = 1 << 18;

struct Chunk {
    std::string type;
    Bytes data;
};

std::vector<Chunk> chunks_of(const Bytes& file) {
    std::vector<Chunk> chunks;
    const ByteReader in(file, ByteOrder::kBig);
    for (std::size_t at = kSignatureBytes; at + 12 <= file.size();) {
        const std::size_t length = in.number_at(at, 4);
        if (length > file.size() - at - 12) break;
        const auto begin = file.begin() + static_cast<std::ptrdiff_t>(at) + 4;
        chunks.push_back({{begin, begin + 4}, {begin + 4, begin + 4 + static_cast<std::ptrdiff_t>(length)}});
        at += length + 12;
    }
    return chunks;
}

Bytes file_of(const Bytes& signature, const std::vector<Chunk>& chunks) {
    Bytes file(signature.begin(), signature.begin() + kSignatureBytes);
    for (const Chunk& chunk : chunks) {
        append_number(file, chunk.data.size(), 4, ByteOrder::kBig);
        const std::size_t begin = file.size();
        file.insert(file.end(), chunk.type.begin(), chunk.type.end());
        file.insert(file.end(), chunk.data.begin(), chunk.data.end());
        append_number(file, libdeflate_crc32(0, file.data() + begin, file.size() - begin), 4,
                      ByteOrder::kBig);
    }
    return file;
}

// Where zlib's bytes begin in a chunk's data; at their end for a chunk without any.
std::size_t compressed_at(const Chunk& chunk) {
    if (chunk.type == "IDAT") return 0;
    if (chunk.type != "iCCP" && chunk.type != "zTXt") return chunk.data.size();
    const auto zero = std::find(chunk.data.begin(), chunk.data.end(), std::uint8_t{0});
    return std::min(static_cast<std::size_t>(zero - chunk.data.begin()) + 2, chunk.data.size());
}

Bytes inflated(const std::uint8_t* data, std::size_t size) {
    const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> decompressor(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    Bytes out(kMostInflated);
    std::size_t length = 0;
    if (libdeflate_zlib_decompress(decompressor.get(), data, size, out.data(), out.size(), &length) !=
        LIBDEFLATE_SUCCESS)
        length = 0;
    out.resize(length);
    return out;
}

Bytes deflated(const Bytes& bytes) {
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
        libdeflate_alloc_compressor(1), libdeflate_free_compressor);
    Bytes out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
    out.resize(
        libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(), out.size()));
    return out;
}

}  // namespace

Bytes Mutator::png(const Bytes& file) {
    std::vector<Chunk> chunks = file.size() < kSignatureBytes ? std::vector<Chunk>{} : chunks_of(file);
    if (chunks.empty() || below(8) == 0) return any(file);
    for (std::uint32_t times = 1 + below(3); times > 0; --times) {
        const std::size_t at = below(chunks.size());
        Chunk& chunk = chunks[at];
        const std::size_t packed = compressed_at(chunk);
        switch (below(8)) {
            case 0:
                chunk.data = any(chunk.data);
                break;
            case 1: {  // another place
                const Chunk copy = chunk;
                if (below(2)) chunks.erase(chunks.begin() + static_cast<std::ptrdiff_t>(at));
                chunks.insert(chunks.begin() + below(chunks.size() + 1), copy);
                break;
            }
            case 2:
                if (below(4) == 0 && chunks.size() > 1)
                    chunks.erase(chunks.begin() + static_cast<std::ptrdiff_t>(at));
                break;
            case 3: {
                constexpr const char* kTypes[] = {"PLTE", "tRNS", "gAMA", "cHRM", "sRGB", "iCCP",
                                                  "cICP", "eXIf", "zTXt", "iTXt", "tEXt", "CgBI"};
                if (chunk.type != "IHDR") chunk.type = kTypes[below(std::size(kTypes))];
                break;
            }
            case 4:  // the head of what a chunk says
                change_bytes(chunk.data, 0, std::min<std::size_t>(chunk.data.size(), 16));
                break;
            default: {
                if (packed == chunk.data.size()) {
                    change_bytes(chunk.data, 0, chunk.data.size());
                    break;
                }
                const Bytes inner =
                    deflated(any(inflated(chunk.data.data() + packed, chunk.data.size() - packed)));
                chunk.data.resize(packed);
                chunk.data.insert(chunk.data.end(), inner.begin(), inner.end());
            }
        }
    }
    return file_of(file, chunks);
}

}  // namespace imgmesh::fuzz
