#include "formats/picture/decode/jpeg2000_packets.h"

#include <algorithm>
#include <array>

#include "formats/files/byte_reader.h"

namespace imgmesh {
namespace {

constexpr std::uint32_t kStartOfTile = 0xFF90, kStartOfData = 0xFF93, kEnd = 0xFFD9;
constexpr std::uint32_t kCodingStyle = 0xFF52, kChannelStyle = 0xFF53, kProgression = 0xFF5F;
constexpr std::size_t kMostResolutions = 33;
constexpr std::int64_t kMostPackets = std::int64_t{1} << 62;

// The largest numbers that any header holds.
struct Styles {
    std::int64_t layers = 0, progressions = 1;
    std::size_t resolutions = 1;
    std::array<int, kMostResolutions> width_bits, height_bits;  // of a precinct, the least

    Styles() {
        constexpr int kWhole = 15;  // a precinct that holds a whole resolution, unless a header says less
        width_bits.fill(kWhole);
        height_bits.fill(kWhole);
    }
};

// Reads the number of resolutions, and the sizes of precincts, of a COD or COC marker.
void add_resolutions(const ByteReader& in, std::size_t at, bool has_precincts, Styles& styles) {
    const std::size_t resolutions = std::min<std::size_t>(in.number_at(at, 1) + 1, kMostResolutions);
    styles.resolutions = std::max(styles.resolutions, resolutions);
    constexpr std::size_t kSizes = 5;  // after the sizes and styles of code-blocks
    for (std::size_t r = 0; has_precincts && r < resolutions; ++r) {
        const auto bits = static_cast<int>(in.number_at(at + kSizes + r, 1));
        styles.width_bits[r] = std::min(styles.width_bits[r], bits & 15);
        styles.height_bits[r] = std::min(styles.height_bits[r], bits >> 4);
    }
}

void add_marker(const ByteReader& in, std::size_t at, std::int64_t channels, Styles& styles) {
    const std::uint32_t marker = in.number_at(at, 2), length = in.number_at(at + 2, 2);
    const std::size_t number = channels < 257 ? 1 : 2;  // bytes of the number of a channel
    if (marker == kCodingStyle) {
        styles.layers = std::max(styles.layers, std::int64_t{in.number_at(at + 6, 2)});
        add_resolutions(in, at + 9, (in.number_at(at + 4, 1) & 1) != 0, styles);
    } else if (marker == kChannelStyle) {
        add_resolutions(in, at + 5 + number, (in.number_at(at + 4 + number, 1) & 1) != 0, styles);
    } else if (marker == kProgression) {
        const auto progressions = static_cast<std::int64_t>((length - 2) / (5 + 2 * number));
        styles.progressions = std::max(styles.progressions, progressions);
    }
}

// Reads the headers of the image and of all tile-parts, which can set these numbers anew.
Styles read_styles(const ByteReader& in, std::size_t size, std::int64_t channels) {
    Styles styles;
    std::size_t part_start = 0, part_length = 0;  // of the tile-part whose header is read
    for (std::size_t at = 2; at + 4 <= size;) {
        const std::uint32_t marker = in.number_at(at, 2), length = in.number_at(at + 2, 2);
        if (marker == kEnd) break;
        if (marker == kStartOfData) {
            if (part_length == 0) break;                      // the last: its data go on to the end
            at = std::max(part_start + part_length, at + 2);  // OpenJPEG takes shorter ones as empty
            continue;
        }
        if (length < 2) break;
        if (marker == kStartOfTile) {
            part_start = at;
            part_length = in.number_at(at + 6, 4);
        }
        add_marker(in, at, channels, styles);
        at += 2 + length;
    }
    return styles;
}

// How many precincts of 2^bits lie along a side, at a resolution that has 2^-level of its size.
std::int64_t along(std::int64_t side, std::size_t level, int bits) {
    const std::int64_t pixels = level > 31 ? 1 : ((side - 1) >> level) + 1;
    return ((pixels - 1) >> bits) + 1;
}

}  // namespace

std::int64_t count_packets(std::span<const std::uint8_t> codestream, const Jpeg2000Tiles& tiles) {
    const ByteReader in(codestream, ByteOrder::kBig);
    const Styles styles = read_styles(in, codestream.size(), tiles.channels);
    double precincts = 0;
    for (std::size_t r = 0; r < styles.resolutions; ++r) {
        const std::size_t level = styles.resolutions - 1 - r;
        precincts += static_cast<double>(along(tiles.width, level, styles.width_bits[r])) *
                     static_cast<double>(along(tiles.height, level, styles.height_bits[r]));
    }
    const double packets = precincts * static_cast<double>(tiles.count) *
                           static_cast<double>(tiles.channels) * static_cast<double>(styles.layers) *
                           static_cast<double>(styles.progressions);
    return packets < static_cast<double>(kMostPackets) ? static_cast<std::int64_t>(packets) : kMostPackets;
}

}  // namespace imgmesh
