#include "formats/exr/exr_header.h"

#include <string_view>

#include "formats/exr/exr_attributes.h"
#include "formats/files/byte_reader.h"
#include "formats/findings/findings.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::size_t kMaxName = 255;
constexpr std::uint32_t kMaxAttributeBytes = 65536;
constexpr int kMaxAttributes = 1000;

Place place_of(const ByteReader& in) {
    return at_byte("layers", in.position());
}

std::string_view take_name(ByteReader& in) {
    const auto name = in.terminated_text(kMaxName);
    if (!name) refuse("layers.header", "a name in the EXR's header does not end", place_of(in));
    return *name;
}

void check_part(ByteReader& in) {
    for (int i = 0; !in.take_if(0); ++i) {
        if (i == kMaxAttributes)
            refuse("layers.header", cat("more than ", kMaxAttributes, " attributes"), place_of(in));
        take_name(in);
        const std::string_view type = take_name(in);
        const std::uint32_t size = in.number(4);
        if (size > kMaxAttributeBytes)
            refuse("layers.attribute", cat("an attribute of ", size, " bytes, at most ", kMaxAttributeBytes),
                   place_of(in));
        const std::size_t start = in.position();
        if (!has_natural_size(type, in.take(size), start))
            refuse("layers.attribute",
                   cat("the EXR has an attribute of type ", type, " with ", size, " bytes"),
                   at_byte("layers", start));
    }
}

void check_headers(ByteReader in, int max_parts) {
    if (in.number(4) != kExrMagic)
        refuse("layers.magic", "the layers are not an EXR file", at_byte("layers", 0));
    const std::uint32_t field = in.number(4), version = field & kExrVersionMask;
    if (version != kExrVersion)
        refuse("layers.magic", cat("EXR version ", version, ", expected ", kExrVersion),
               at_byte("layers", 4));
    if (field & ~(kExrVersionMask | kExrTiled | kExrLongNames | kExrMultiPart))
        refuse("layers.type", "the EXR has deep parts or unknown flags", at_byte("layers", 4));
    check_part(in);
    if (!(field & kExrMultiPart)) return;
    for (int parts = 1; !in.take_if(0); ++parts) {
        if (parts == max_parts)
            refuse("layers.parts", cat("the EXR has more than ", max_parts, " parts"), place_of(in));
        check_part(in);
    }
}

}  // namespace

void check_exr_header(std::span<const std::uint8_t> bytes, int max_parts) {
    try {
        check_headers({bytes, ByteOrder::kLittle}, max_parts);
    } catch (const EndOfBytes& end) {
        refuse("layers.header", "the EXR ends in its header", at_byte("layers", end.position));
    }
}

}  // namespace imgmesh
