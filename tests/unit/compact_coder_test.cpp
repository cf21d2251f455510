// The coder of displacements against a slow one, and its parts.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "formats/compact/band_decode.h"
#include "formats/compact/band_encode.h"
#include "formats/compact/band_fit.h"
#include "tests/support/compact_reference.h"

using namespace imgmesh;
using namespace imgmesh::compact;

namespace {

using Bytes = std::vector<std::uint8_t>;

struct Field {
    int width, rows;
    std::vector<std::int16_t> dx, dy;
    std::vector<std::uint8_t> inside;

    Band band() const { return {width, rows, dx, dy, inside}; }
};

// Waves with noise, along a direction, as pixels move along the gradient of colours; `noise` in steps.
Field waves(int width, int rows, double noise, bool masked, std::mt19937& random) {
    Field field{width, rows, {}, {}, {}};
    std::normal_distribution<double> normal(0, noise);
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < width; ++x) {
            const double along = normal(random), angle = 0.02 * x + 0.03 * y;
            const bool inside = !masked || (x * x + y * y) % 50 > 9;
            field.dx.push_back(inside ? static_cast<std::int16_t>(30 * std::sin(angle) + along)
                                      : std::int16_t{0});
            field.dy.push_back(inside
                                   ? static_cast<std::int16_t>(20 * std::cos(angle) + along * std::sin(angle))
                                   : std::int16_t{0});
            if (masked) field.inside.push_back(inside);
        }
    return field;
}

Field extremes(int width, int rows, std::mt19937& random) {
    Field field{width, rows, {}, {}, {}};
    for (int i = 0; i < width * rows; ++i) {
        const auto any = [&] {
            const std::uint32_t kind = random() % 4;
            return static_cast<std::int16_t>(kind == 0   ? 32767
                                             : kind == 1 ? -32768
                                             : kind == 2 ? 0
                                                         : random());
        };
        field.dx.push_back(any());
        field.dy.push_back(any());
    }
    return field;
}

void check(const Field& field, const std::array<Taps, 2>& taps) {
    const BandTokens tokens = band_tokens(field.band(), taps);
    const Bytes table = table_bytes(taps, tokens.counts);
    const std::optional<BandTables> tables = read_tables(table);
    REQUIRE(tables);
    CHECK(tables->taps == taps);
    Bytes bytes;
    put_band(bytes, tokens, *tables);
    bytes.resize(bytes.size() + 3);  // zeros may follow
    std::vector<std::int16_t> dx(field.dx.size()), dy(field.dx.size()), dx2 = dx, dy2 = dy;
    const DecodeTables for_decoder(*tables);
    const CodedBand first{bytes, field.width, field.rows, dx, dy, field.inside},
        second{bytes, field.width, field.rows, dx2, dy2, field.inside};
    CHECK(decode_bands(first, nullptr, for_decoder));
    CHECK(dx == field.dx);
    CHECK(dy == field.dy);
    std::ranges::fill(dx, std::int16_t{1});
    CHECK(decode_bands(first, &second, for_decoder));
    CHECK(dx == field.dx);
    CHECK(dx2 == field.dx);
    CHECK(dy2 == field.dy);
    std::ranges::fill(dx, std::int16_t{1});
    CompactReference(first, *tables).decode();
    CHECK(dx == field.dx);
    CHECK(dy == field.dy);
    bytes.back() = 1;
    CHECK(!decode_bands(first, nullptr, for_decoder));
}

}  // namespace

// Three decoders give back what went in: the slow one, the fast one, and the fast one with two bands at once.
TEST_CASE("compact coder: equal to the slow one") {
    std::mt19937 random(1);
    const Taps plain = {208, -40, 160, -88, 48, -32, 0, 0, 0, 0};
    Taps wild;
    for (std::int16_t& tap : wild) tap = static_cast<std::int16_t>(static_cast<int>(random() % 2047) - 1023);
    for (const auto& taps : {std::array{plain, plain}, std::array{plain, wild}, std::array{wild, wild}})
        for (const auto& [width, rows] :
             {std::pair(1, 1), {1, 40}, {40, 1}, {2, 3}, {7, 9}, {8, 8}, {64, 20}, {2500, 5}}) {
            check(waves(width, rows, 0, false, random), taps);
            check(waves(width, rows, 3, false, random), taps);
            check(waves(width, rows, 40, true, random), taps);
            check(extremes(width, rows, random), taps);
        }
}

// A wave that repeats what stands above and on the left is predicted without a rest: its taps are found.
TEST_CASE("compact coder: fitted taps predict") {
    std::vector<std::int16_t> plane;
    for (int y = 0; y < 50; ++y)
        for (int x = 0; x < 60; ++x) plane.push_back(static_cast<std::int16_t>(5 * x - 3 * y + 100));
    const Taps taps = fit_taps(plane, 60, 50);
    int sum = 0;
    for (const std::int16_t tap : taps) sum += tap;
    CHECK(std::abs(sum - 256) <= 2);
    CHECK(fit_taps(std::vector<std::int16_t>(3, 9), 3, 1) == fit_taps(std::vector<std::int16_t>(1, 0), 1, 1));
}

// What is coded takes about the entropy: the noise of one component is told by the other's where they move
// together, and costs nothing twice.
TEST_CASE("compact coder: as few bits as the noise has") {
    std::mt19937 random(2);
    const Field field = waves(400, 300, 4, false, random);
    const std::array<Taps, 2> taps{fit_taps(field.dx, 400, 300), fit_taps(field.dy, 400, 300)};
    const BandTokens tokens = band_tokens(field.band(), taps);
    Bytes bytes;
    put_band(bytes, tokens, read_tables(table_bytes(taps, tokens.counts)).value());
    // Of a normal distribution: log2(4 sqrt(2 pi e)) = 4.05 bits, of dx alone.
    const double bits = 8.0 * static_cast<double>(bytes.size()) / (400 * 300);
    CHECK(bits > 4.0);
    CHECK(bits < 8.1 - 1.5);
}

TEST_CASE("compact coder: broken tables") {
    std::mt19937 random(3);
    const Field field = waves(100, 100, 5, false, random);
    const std::array<Taps, 2> taps{};
    const Bytes bytes = table_bytes(taps, band_tokens(field.band(), taps).counts);
    REQUIRE(read_tables(bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size) CHECK(!read_tables(std::span(bytes).first(size)));
    Bytes longer = bytes;
    longer.push_back(0);
    CHECK(!read_tables(longer));
    Bytes large = bytes;
    large[1] = 4;  // the first tap is 1024 / 256
    CHECK(!read_tables(large));
    for (int i = 0; i < 2000; ++i) {
        Bytes other = bytes;
        other[random() % other.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
        const std::optional<BandTables> tables = read_tables(other);
        if (!tables) continue;
        for (const TokenSlots& slots : tables->tables) {
            int all = 0;
            for (const Slots& token : slots) all += token.frequency;
            CHECK(all == 1 << kFrequencyBits);
        }
    }
}
