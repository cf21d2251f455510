#include "formats/picture/decode/jpeg2000_packets.h"

#include <doctest/doctest.h>

#include <vector>

using namespace imgmesh;

namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes operator+(Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

const Bytes kStart = {0xFF, 0x4F};
const Bytes kData = {0xFF, 0x93};
const Bytes kFiveLayers = {0xFF, 0x52, 0, 12, 0, 0, 0, 5, 0, 1, 4, 4, 0, 0};  // two resolutions
// The same with precincts of 4 x 2 pixels at the half size, 8 x 8 at the full one.
const Bytes kPrecincts = {0xFF, 0x52, 0, 14, 1, 0, 0, 5, 0, 1, 4, 4, 0, 0, 0x12, 0x33};

Bytes tile_part(std::uint8_t length) {
    return {0xFF, 0x90, 0, 10, 0, 0, 0, 0, 0, length, 0, 1};
}

}  // namespace

TEST_CASE("one packet for each layer, resolution, channel and precinct of a tile") {
    const Jpeg2000Tiles tiles{4, 16, 16, 3};
    CHECK(count_packets(kStart + kFiveLayers, tiles) == 4 * 3 * 5 * 2);
    // 8 x 8 pixels in precincts of 4 x 2, and 16 x 16 in 8 x 8.
    CHECK(count_packets(kStart + kPrecincts, tiles) == 4 * 3 * 5 * (2 * 4 + 2 * 2));
    CHECK(count_packets(kStart, tiles) == 0);
    CHECK(count_packets({}, tiles) == 0);
}

TEST_CASE("headers of tile-parts count, behind the data of others too") {
    const Jpeg2000Tiles tiles{2, 16, 16, 1};
    const Bytes first = tile_part(16) + kData + Bytes{1, 2};
    CHECK(count_packets(kStart + first + tile_part(0) + kFiveLayers + kData, tiles) == 2 * 5 * 2);
    const Bytes empty = tile_part(3) + kData;  // its end lies before its data
    CHECK(count_packets(kStart + empty + tile_part(0) + kFiveLayers + kData, tiles) == 2 * 5 * 2);
    const Bytes last = tile_part(0) + kData;  // what follows is data
    CHECK(count_packets(kStart + last + tile_part(0) + kFiveLayers + kData, tiles) == 0);
}

TEST_CASE("each change of the progression steps through the packets again") {
    const Bytes twice = {0xFF, 0x5F, 0, 16, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 1, 1, 1, 0};
    CHECK(count_packets(kStart + kFiveLayers + twice, {1, 8, 8, 1}) == 2 * 5 * 2);
}

TEST_CASE("numbers that are too large are counted as the largest") {
    const Jpeg2000Tiles tiles{65535, 1 << 30, 1 << 30, 16384};
    const Bytes tiny = {0xFF, 0x52, 0, 14, 1, 0, 0xFF, 0xFF, 0, 1, 4, 4, 0, 0, 0, 0};
    CHECK(count_packets(kStart + tiny, tiles) == std::int64_t{1} << 62);
}
