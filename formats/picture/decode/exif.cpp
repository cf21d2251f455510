#include "formats/picture/decode/exif.h"

#include <string_view>

#include "formats/files/byte_reader.h"

namespace imgmesh {

int exif_orientation(std::span<const std::uint8_t> exif) {
    constexpr std::string_view kPrefix("Exif\0\0", 6);  // JPEG's, which some writers copy
    if (text_of(exif).starts_with(kPrefix)) exif = exif.subspan(kPrefix.size());
    if (exif.size() < 8) return 1;
    const ByteReader in(exif, exif[0] == 'M' ? ByteOrder::kBig : ByteOrder::kLittle);
    const std::size_t directory = in.number_at(4, 4), entries = in.number_at(directory, 2);
    for (std::size_t i = 0; i < entries; ++i) {
        const std::size_t entry = directory + 2 + 12 * i;
        if (in.number_at(entry, 2) != 0x0112) continue;
        const auto value = static_cast<int>(in.number_at(entry + 8, 2));
        return value >= 1 && value <= 8 ? value : 1;
    }
    return 1;
}

}  // namespace imgmesh
