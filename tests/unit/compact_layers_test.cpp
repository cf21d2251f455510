#include "formats/compact/compact_layers.h"

#include <doctest/doctest.h>

#include <random>

#include "formats/compact/compact_bands.h"
#include "formats/findings/findings.h"
#include "libcore/base/error.h"
#include "libcore/base/parallel.h"

using namespace imgmesh;

namespace {

using Bytes = std::vector<std::uint8_t>;

// A walk from pixel to pixel, with some leaps to the ends of what a displacement may be. The first is odd, so
// that no coarser steps hold the map.
CompactPart random_part(int width, int height, std::mt19937& random) {
    CompactPart part{"lod0", {}, WeightPrecision::kHalf, {}, std::string(64, 'a')};
    part.map.width = width;
    part.map.height = height;
    int x = 0, y = 0;
    for (std::size_t i = 0; i < part.map.pixel_count(); ++i) {
        x += static_cast<int>(random() % 9) - 4;
        y += static_cast<int>(random() % 5) - 2;
        if (random() % 500 == 0) x = random() % 2 ? 32767 : -32768;
        if (random() % 500 == 0) y = static_cast<int>(random() % 65536) - 32768;
        x = std::clamp(x, -32768, 32767);
        y = std::clamp(y, -32768, 32767);
        part.map.dx.push_back(static_cast<std::int16_t>(x));
        part.map.dy.push_back(static_cast<std::int16_t>(y));
    }
    part.map.dx[0] = 7;
    return part;
}

// Hides pixels; the first stays inside, the last does not.
void mask(CompactPart& part, std::mt19937& random) {
    if (part.map.pixel_count() == 1) return;
    part.map.inside = Mask(part.map);
    for (std::size_t i = 0; i < part.map.pixel_count(); ++i) {
        part.map.inside[i] = i == 0 || (i + 1 < part.map.pixel_count() && random() % 8 != 0);
        if (!part.map.inside[i]) part.map.dx[i] = part.map.dy[i] = 0;
    }
}

ExpectedLayers expect(const std::vector<CompactPart>& parts) {
    ExpectedLayers expected{parts[0].map.width, parts[0].map.height, {}, {}, true};
    for (const CompactPart& part : parts) expected.parts.push_back(part.name);
    return expected;
}

void check_round_trip(const std::vector<CompactPart>& parts) {
    const Bytes bytes = encode_compact_layers(parts);
    const std::vector<CompactPart> decoded = decode_compact_layers(bytes, expect(parts));
    REQUIRE(decoded.size() == parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        CHECK(decoded[i].name == parts[i].name);
        CHECK(decoded[i].map == parts[i].map);
        CHECK(decoded[i].precision == parts[i].precision);
        CHECK(decoded[i].visits == parts[i].visits);
        CHECK(decoded[i].topology == parts[i].topology);
    }
}

// Returns the code of the finding; "" if the bytes are read.
std::string finding(const Bytes& bytes, const ExpectedLayers& expected) {
    try {
        decode_compact_layers(bytes, expected);
    } catch (const FindingError& error) {
        return std::string(error.code());
    }
    return "";
}

}  // namespace

// The stream is lossless: for sizes with one band and several, of one column and of one row, with masks and
// visits, and for the largest displacements.
TEST_CASE("compact layers: what is stored comes back") {
    std::mt19937 random(1);
    for (const GridSize& size : {GridSize{1, 1}, {1, 7}, {9, 1}, {17, 5}, {300, 500}, {3, 70000}}) {
        INFO(size.width, "x", size.height);
        std::vector<CompactPart> parts(1, random_part(size.width, size.height, random));
        check_round_trip(parts);
        mask(parts[0], random);
        check_round_trip(parts);
        parts.push_back(random_part(size.width, size.height, random));
        parts[1].name = "lod1";
        parts[1].precision = WeightPrecision::kFloat;
        parts[1].topology = "";
        for (std::size_t i = 0; i < parts[0].map.pixel_count(); ++i)
            parts[0].visits.push_back(static_cast<Id>(random()));
        check_round_trip(parts);
    }
}

// An image that is still everywhere would take no bits; it takes a byte for 1024 pixels.
TEST_CASE("compact layers: flat maps are small, but not smaller than what bounds their pixels") {
    CompactPart part{"lod0", {}, WeightPrecision::kHalf, {}, {}};
    part.map.width = 1024;
    part.map.height = 1024;
    part.map.steps = 8;
    part.map.dx.assign(1 << 20, 7);
    part.map.dy.assign(1 << 20, -3);
    check_round_trip({part});
    const std::size_t size = encode_compact_layers(std::vector{part}).size();
    CHECK(size >= 1024);
    CHECK(size < 4000);
}

// Who reads the map does not see with which steps it was made, so equal maps are equal files.
TEST_CASE("compact layers: the coarsest steps are stored") {
    std::mt19937 random(2);
    CompactPart coarse = random_part(20, 20, random);
    coarse.map.steps = 8;
    for (std::vector<std::int16_t>* d : {&coarse.map.dx, &coarse.map.dy})
        for (std::int16_t& value : *d) value = static_cast<std::int16_t>(value / 4 | 1);
    CompactPart fine = coarse;
    fine.map.steps = 32;
    for (std::vector<std::int16_t>* d : {&fine.map.dx, &fine.map.dy})
        for (std::int16_t& value : *d) value = static_cast<std::int16_t>(4 * value);
    const Bytes bytes = encode_compact_layers(std::vector{fine});
    CHECK(bytes == encode_compact_layers(std::vector{coarse}));
    CHECK(decode_compact_layers(bytes, expect({fine}))[0].map == coarse.map);
}

TEST_CASE("compact layers: the same bytes with any number of threads") {
    std::mt19937 random(3);
    const std::vector<CompactPart> parts(1, random_part(500, 700, random));
    const Bytes bytes = encode_compact_layers(parts);
    const ThreadLimit one(1);
    CHECK(encode_compact_layers(parts) == bytes);
    CHECK(decode_compact_layers(bytes, expect(parts))[0].map == parts[0].map);
}

// A band is decoded without the others, as a reader does that has no room for all.
TEST_CASE("compact layers: bands by themselves") {
    std::mt19937 random(4);
    const std::vector<CompactPart> parts(1, random_part(600, 300, random));
    const Displacements& map = parts[0].map;
    const Bytes bytes = encode_compact_layers(parts);
    Findings findings = Findings::strict();
    const CompactStream stream(bytes, expect(parts), findings);
    const CompactStream::Part& part = stream.parts()[0];
    REQUIRE(part.bands > 1);
    for (int band = part.bands; band-- > 0;) {
        const std::size_t first = map.row_begin(band * part.band_rows),
                          count = std::min(map.pixel_count() - first, std::size_t(part.band_rows) * 600);
        std::vector<std::int16_t> dx(count), dy(count);
        stream.decode(0, band, {dx, dy, {}, {}});
        CHECK(std::equal(dx.begin(), dx.end(), map.dx.begin() + std::ptrdiff_t(first)));
        CHECK(std::equal(dy.begin(), dy.end(), map.dy.begin() + std::ptrdiff_t(first)));
    }
}

TEST_CASE("compact layers: other images, other levels, other streams") {
    std::mt19937 random(5);
    std::vector<CompactPart> parts(1, random_part(40, 30, random));
    mask(parts[0], random);
    const Bytes bytes = encode_compact_layers(parts);
    ExpectedLayers expected = expect(parts);
    CHECK(finding(bytes, expected) == "");
    expected.width = 41;
    CHECK(finding(bytes, expected) == "layers.window");
    expected.width = 40000000;
    CHECK(finding(bytes, expected) == "layers.size");
    expected = expect(parts);
    expected.has_mask = false;
    CHECK(finding(bytes, expected) == "layers.mask");
    expected.parts = {"lod1"};
    CHECK(finding(bytes, expected) == "layers.parts");
    expected.parts = {"lod0", "lod1"};
    CHECK(finding(bytes, expected) == "layers.parts");
    expected = expect(parts);
    const auto with = [&](std::size_t at, std::uint8_t value) {
        Bytes other = bytes;
        other[at] = value;
        return finding(other, expected);
    };
    CHECK(with(0, 'X') == "layers.magic");
    CHECK(with(4, 2) == "layers.version");
    CHECK(with(5, 9) == "");                 // a later minor version
    CHECK(with(13, 12) == "layers.header");  // the steps
    Bytes longer = bytes;
    longer.push_back(0);
    CHECK(finding(longer, expected) == "layers.header");
}

// Whatever the bytes, the reader ends with a result or a finding.
TEST_CASE("compact layers: cut and changed bytes") {
    std::mt19937 random(6);
    std::vector<CompactPart> parts(1, random_part(40, 30, random));
    parts[0].visits.assign(1200, 3);
    mask(parts[0], random);
    const Bytes bytes = encode_compact_layers(parts);
    const ExpectedLayers expected = expect(parts);
    for (std::size_t size = 0; size < bytes.size(); ++size)
        CHECK(finding({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}, expected) != "");
    for (int i = 0; i < 3000; ++i) {
        Bytes other = bytes;
        for (int k = 0; k <= i % 3; ++k)
            other[random() % bytes.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
        finding(other, expected);
    }
}

TEST_CASE("compact layers: what no part can be") {
    std::mt19937 random(7);
    const CompactPart part = random_part(4, 3, random);
    const auto throws = [&](auto change) {
        CompactPart other = part;
        change(other);
        CHECK_THROWS_AS(encode_compact_layers(std::vector{other}), Error);
    };
    throws([](CompactPart& p) { p.map.dx.pop_back(); });
    throws([](CompactPart& p) { p.map.steps = 12; });
    throws([](CompactPart& p) { p.visits.resize(3); });
    throws([](CompactPart& p) { p.topology = "no hash"; });
    throws([](CompactPart& p) { p.name.assign(256, 'x'); });
    throws([](CompactPart& p) {
        p.map.inside = Mask(p.map);
        p.map.dx[2] = 1;
    });
}
