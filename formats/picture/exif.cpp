#include "formats/picture/exif.h"

#include <algorithm>
#include <iterator>

namespace imgmesh {

int exif_orientation(std::span<const std::uint8_t> exif) {
    constexpr std::uint8_t kPrefix[] = {'E', 'x', 'i', 'f', 0, 0};  // JPEG's, which some writers copy
    if (exif.size() > 6 && std::equal(std::begin(kPrefix), std::end(kPrefix), exif.begin()))
        exif = exif.subspan(6);
    if (exif.size() < 8) return 1;
    const bool big = exif[0] == 'M';
    const auto number = [&](std::size_t at, std::size_t count) {
        std::uint32_t value = 0;
        if (at > exif.size() || count > exif.size() - at) return value;
        for (std::size_t i = 0; i < count; ++i) value = value << 8 | exif[at + (big ? i : count - 1 - i)];
        return value;
    };
    const std::size_t directory = number(4, 4), entries = number(directory, 2);
    for (std::size_t i = 0; i < entries; ++i) {
        const std::size_t entry = directory + 2 + 12 * i;
        if (number(entry, 2) != 0x0112) continue;
        const auto value = static_cast<int>(number(entry + 8, 2));
        return value >= 1 && value <= 8 ? value : 1;
    }
    return 1;
}

}  // namespace imgmesh
