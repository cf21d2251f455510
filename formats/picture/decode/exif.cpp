#include "formats/picture/decode/exif.h"

#include <optional>

#include "formats/files/byte_reader.h"

namespace imgmesh {
namespace {

// Returns the place of a tag's value, or of the offset of its value.
std::optional<std::size_t> find_tag(const ByteReader& in, std::size_t directory, std::uint32_t tag) {
    const std::size_t entries = in.number_at(directory, 2);
    for (std::size_t i = 0; i < entries; ++i) {
        const std::size_t entry = directory + 2 + 12 * i;
        if (in.number_at(entry, 2) == tag) return entry + 8;
    }
    return std::nullopt;
}

int valid(std::uint32_t orientation) {
    return orientation >= 1 && orientation <= 8 ? static_cast<int>(orientation) : 0;
}

}  // namespace

ExifFacts exif_facts(std::span<const std::uint8_t> exif) {
    constexpr std::uint32_t kOrientation = 0x0112, kExif = 0x8769, kColorSpace = 0xA001, kInterop = 0xA005,
                            kIndex = 0x0001;
    constexpr std::string_view kPrefix("Exif\0\0", 6);  // JPEG's, which some writers copy
    if (text_of(exif).starts_with(kPrefix)) exif = exif.subspan(kPrefix.size());
    ExifFacts facts;
    if (exif.size() < 8) return facts;
    const ByteReader in(exif, exif[0] == 'M' ? ByteOrder::kBig : ByteOrder::kLittle);
    const std::size_t first = in.number_at(4, 4);
    if (const auto at = find_tag(in, first, kOrientation)) facts.orientation = valid(in.number_at(*at, 2));
    const auto details = find_tag(in, first, kExif);
    if (!details) return facts;
    const std::size_t directory = in.number_at(*details, 4);
    const auto space = find_tag(in, directory, kColorSpace), interop = find_tag(in, directory, kInterop);
    constexpr std::uint32_t kUncalibrated = 0xFFFF, kAdobe = 2;  // 2 is what some cameras write
    if (!space) return facts;
    const std::uint32_t number = in.number_at(*space, 2);
    const auto index = interop ? find_tag(in, in.number_at(*interop, 4), kIndex) : std::nullopt;
    facts.adobe_rgb = number == kAdobe || (number == kUncalibrated && index && in.has_at(*index, "R03"));
    return facts;
}

int xmp_orientation(std::string_view xmp) {
    constexpr std::string_view kName = "tiff:Orientation", kBetween = " \t\r\n=\"'>";
    for (std::size_t at = xmp.find(kName); at != std::string_view::npos; at = xmp.find(kName, at + 1)) {
        const std::size_t value = xmp.find_first_not_of(kBetween, at + kName.size());
        if (value == std::string_view::npos) return 0;
        if (xmp[value] >= '0' && xmp[value] <= '9')
            return valid(static_cast<std::uint32_t>(xmp[value] - '0'));
    }
    return 0;
}

}  // namespace imgmesh
