// Source: glTF 2.0 specification, section 4 "GLB File Format Specification".
#include "formats/gltf/glb.h"

#include <cstring>
#include <limits>

#include "formats/findings/findings.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

std::uint32_t number(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

std::size_t padded(std::size_t size) {
    return (size + 3) / 4 * 4;
}

}  // namespace

bool is_glb(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= 4 && number(bytes, 0) == kMagic;
}

std::vector<std::uint8_t> glb_head(std::string_view json, std::uint64_t binary_bytes) {
    const std::size_t json_bytes = padded(json.size());
    const std::uint64_t total = kHeaderBytes + 2 * kChunkHeaderBytes + json_bytes + binary_bytes;
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorKind::kUnsupported,
                    cat("a .glb holds at most 4 GiB, this one would need ", total, " bytes; write a .gltf"));
    std::vector<std::uint8_t> bytes;
    const auto put = [&](std::uint64_t value) {
        for (int shift = 0; shift < 32; shift += 8)
            bytes.push_back(static_cast<std::uint8_t>(value >> shift));
    };
    put(kMagic);
    put(2);
    put(total);
    put(json_bytes);
    put(kJson);
    bytes.insert(bytes.end(), json.begin(), json.end());
    bytes.resize(bytes.size() + json_bytes - json.size(), ' ');
    put(binary_bytes);
    put(kBinary);
    return bytes;
}

std::vector<std::uint8_t> pack_glb(std::string_view json, std::span<const std::uint8_t> binary) {
    std::vector<std::uint8_t> bytes = glb_head(json, padded(binary.size()));
    const std::size_t total = bytes.size() + padded(binary.size());
    bytes.insert(bytes.end(), binary.begin(), binary.end());
    bytes.resize(total, 0);
    return bytes;
}

GlbView unpack_glb(std::span<const std::uint8_t> bytes, Findings& findings) {
    if (!is_glb(bytes) || bytes.size() < kHeaderBytes || number(bytes, 4) != 2)
        refuse("glb.header", "not a glTF 2.0 binary file", at_byte("file", 0));
    if (number(bytes, 8) != bytes.size())
        findings.add("glb.length",
                     cat("the header says ", number(bytes, 8), " bytes, the file has ", bytes.size()),
                     at_byte("file", 8));
    GlbView view;
    bool has_json = false, has_binary = false;
    for (std::size_t at = kHeaderBytes; at < bytes.size();) {
        if (bytes.size() - at < kChunkHeaderBytes)
            refuse("glb.chunk", "the file ends in a chunk's header", at_byte("file", at));
        const std::uint32_t length = number(bytes, at), type = number(bytes, at + 4);
        at += kChunkHeaderBytes;
        if (length > bytes.size() - at)
            refuse("glb.chunk", cat("a chunk of ", length, " bytes, ", bytes.size() - at, " are left"),
                   at_byte("file", at));
        if (length % 4 != 0)
            findings.add("glb.padding", cat("a chunk of ", length, " bytes"), at_byte("file", at));
        const auto content = bytes.subspan(at, length);
        if (!has_json) {
            if (type != kJson) refuse("glb.chunk", "the first chunk is not JSON", at_byte("file", at));
            view.json = {reinterpret_cast<const char*>(content.data()), content.size()};
            has_json = true;
        } else if (type == kBinary && !has_binary) {
            view.binary = content;
            has_binary = true;
        } else {
            findings.add("glb.unknown_chunk", cat("a chunk of type ", type), at_byte("file", at));
        }
        at += length;
    }
    if (!has_json) refuse("glb.chunk", "no JSON chunk", at_byte("file", kHeaderBytes));
    return view;
}

}  // namespace imgmesh
