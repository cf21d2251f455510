#include "formats/exr/exr_opaque.h"

#include <limits>
#include <string_view>

#include "formats/exr/exr_attributes.h"
#include "formats/files/byte_reader.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

std::string_view take_name(ByteReader& in) {
    const auto name = in.terminated_text(std::numeric_limits<std::size_t>::max());
    if (!name) throw EndOfBytes{in.position()};
    return *name;
}

std::size_t rename_attributes(const std::string& path, std::span<std::uint8_t> bytes) {
    ByteReader in(bytes, ByteOrder::kLittle);
    in.take(4);  // the signature
    const std::uint32_t field = in.number(4), version = field & kExrVersionMask;
    if (version != kExrVersion)
        throw Error(ErrorKind::kBadFile, cat(path, ": EXR version ", version, ", expected ", kExrVersion));
    // An empty name ends a header, and an empty header those of a file with many parts.
    do {
        while (!in.take_if(0)) {
            take_name(in);
            const std::size_t type_position = in.position();
            const std::string_view type = take_name(in);
            const std::uint32_t size = in.number(4);
            const std::size_t start = in.position();
            if (!has_natural_size(type, in.take(size), start) && !type.empty())
                bytes[type_position] = '~';  // no type begins so
        }
    } while ((field & kExrMultiPart) && !in.take_if(0));
    return in.position();
}

}  // namespace

std::optional<std::size_t> make_start_opaque(const std::string& path, std::span<std::uint8_t> bytes) {
    try {
        return rename_attributes(path, bytes);
    } catch (const EndOfBytes&) {
        return {};
    }
}

void make_attributes_opaque(const std::string& path, std::span<std::uint8_t> bytes) {
    if (!make_start_opaque(path, bytes))
        throw Error(ErrorKind::kBadFile, cat(path, ": the EXR ends in its header"));
}

}  // namespace imgmesh
