// Source: glTF 2.0 specification, section 4 "GLB File Format Specification".
#include "formats/gltf/glb.h"

#include <limits>

#include "formats/files/byte_reader.h"
#include "formats/files/byte_writer.h"
#include "formats/findings/findings.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67, kJson = 0x4E4F534A, kBinary = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

std::size_t padded(std::size_t size) {
    return (size + 3) / 4 * 4;
}

}  // namespace

bool is_glb(std::span<const std::uint8_t> bytes) {
    return ByteReader(bytes, ByteOrder::kLittle).number_at(0, 4) == kMagic;
}

std::vector<std::uint8_t> glb_head(std::string_view json, std::uint64_t binary_bytes) {
    const std::size_t json_bytes = padded(json.size());
    const std::uint64_t total = kHeaderBytes + 2 * kChunkHeaderBytes + json_bytes + binary_bytes;
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorKind::kUnsupported,
                    cat("a .glb holds at most 4 GiB, this one would need ", total, " bytes; write a .gltf"));
    std::vector<std::uint8_t> bytes;
    const auto put = [&](std::uint64_t value) { append_number(bytes, value, 4, ByteOrder::kLittle); };
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
    ByteReader in(bytes, ByteOrder::kLittle);
    const auto place = [&] { return at_byte("file", in.position()); };
    if (!is_glb(bytes) || bytes.size() < kHeaderBytes || in.number_at(4, 4) != 2)
        refuse("glb.header", "not a glTF 2.0 binary file", place());
    in.take(kHeaderBytes - 4);
    const std::uint32_t total = in.number_at(8, 4);
    if (total != bytes.size())
        findings.add("glb.length", cat("the header says ", total, " bytes, the file has ", bytes.size()),
                     place());
    in.take(4);
    GlbView view;
    bool has_json = false, has_binary = false;
    while (in.left() > 0) {
        if (in.left() < kChunkHeaderBytes) refuse("glb.chunk", "the file ends in a chunk's header", place());
        const std::uint32_t length = in.number(4), type = in.number(4);
        if (length > in.left())
            refuse("glb.chunk", cat("a chunk of ", length, " bytes, ", in.left(), " are left"), place());
        const Place start = place();
        if (length % 4 != 0) findings.add("glb.padding", cat("a chunk of ", length, " bytes"), start);
        const auto content = in.take(length);
        if (!has_json) {
            if (type != kJson) refuse("glb.chunk", "the first chunk is not JSON", start);
            view.json = text_of(content);
            has_json = true;
        } else if (type == kBinary && !has_binary) {
            view.binary = content;
            has_binary = true;
        } else {
            findings.add("glb.unknown_chunk", cat("a chunk of type ", type), start);
        }
    }
    if (!has_json) refuse("glb.chunk", "no JSON chunk", at_byte("file", kHeaderBytes));
    return view;
}

}  // namespace imgmesh
