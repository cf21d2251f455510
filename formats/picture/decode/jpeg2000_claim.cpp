// Source: T.800 - boxes (I.4), the codestream's first markers (A.4.1, A.5.1).
#include "formats/picture/decode/jpeg2000_claim.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "formats/files/byte_reader.h"
#include "formats/picture/decode/jpeg2000_packets.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr std::string_view kStart = "\xFF\x4F\xFF\x51";  // SOC and SIZ, one right after the other

// Returns where the codestream begins.
std::optional<std::uint64_t> find_codestream(const ByteReader& in, std::uint64_t size) {
    if (in.has_at(0, kStart)) return 0;
    for (std::uint64_t at = 0; at + 8 <= size;) {
        const auto place = static_cast<std::size_t>(at);
        std::uint64_t length = in.number_at(place, 4), head = 8;
        if (length == 1) {
            length = (std::uint64_t{in.number_at(place + 8, 4)} << 32) | in.number_at(place + 12, 4);
            head = 16;
        }
        if (length == 0) length = size - at;  // to the end of the file
        if (in.has_at(place + 4, "jp2c"))
            return in.has_at(static_cast<std::size_t>(at + head), kStart) ? std::optional(at + head)
                                                                          : std::nullopt;
        if (length < head || length > size - at) return std::nullopt;
        at += length;
    }
    return std::nullopt;
}

std::int64_t tiles_along(std::int64_t end, std::int64_t origin, std::int64_t side) {
    return (end - origin + side - 1) / side;
}

}  // namespace

void claim_jpeg2000(const std::string& path, std::span<const std::uint8_t> bytes, PictureClaim& claim) {
    const auto broken = [&](const std::string& what) {
        return Error(ErrorKind::kBadFile, cat(path, ": cannot read the JPEG 2000: ", what));
    };
    const ByteReader in(bytes, ByteOrder::kBig);
    const std::optional<std::uint64_t> start = find_codestream(in, bytes.size());
    if (!start) throw broken("it has no codestream");
    const auto number = [&](std::size_t offset, int count) {
        return std::int64_t{in.number_at(static_cast<std::size_t>(*start) + offset, count)};
    };
    const std::int64_t right = number(8, 4), bottom = number(12, 4);
    const std::int64_t tile_width = number(24, 4), tile_height = number(28, 4);
    claim.width = right - number(16, 4);
    claim.height = bottom - number(20, 4);
    claim.channels = number(40, 2);
    if (claim.width < 1 || claim.height < 1 || claim.channels < 1 || tile_width < 1 || tile_height < 1)
        throw broken(cat("its size is ", claim.width, "x", claim.height, " in tiles of ", tile_width, "x",
                         tile_height, " with ", claim.channels, " channels"));
    const std::int64_t columns = tiles_along(right, number(32, 4), tile_width),
                       rows = tiles_along(bottom, number(36, 4), tile_height);
    // OpenJPEG takes some kilobytes for each tile at once. T.800 has room for 65535.
    constexpr std::int64_t kMostTiles = 65535, kAlways = 1024, kLeastPixels = 256;
    const bool too_many =
        columns < 1 || rows < 1 || columns > kMostTiles || rows > kMostTiles || columns * rows > kMostTiles;
    if (too_many ||
        (columns * rows > kAlways && claim.width * claim.height / (columns * rows) < kLeastPixels))
        throw broken(cat("the image is ", claim.width, "x", claim.height, " in ", columns, " x ", rows,
                         " tiles, expected 1 to ", kMostTiles, ", of ", kLeastPixels,
                         " pixels if there are many"));
    // A packet takes a byte at least, and OpenJPEG steps through all of them, also through those that the
    // file does not have. Twenty-five million take it three seconds.
    constexpr std::int64_t kFewPackets = 4'000'000;
    const std::int64_t packets = count_packets(bytes.subspan(static_cast<std::size_t>(*start)),
                                               {columns * rows, std::min(tile_width, claim.width),
                                                std::min(tile_height, claim.height), claim.channels});
    const auto most = std::max(kFewPackets, static_cast<std::int64_t>(bytes.size()));
    if (packets > most)
        throw broken(
            cat("it speaks of ", packets, " packets, expected at most ", most, " in so small a file"));
}

}  // namespace imgmesh
