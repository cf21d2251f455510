#include <algorithm>
#include <cmath>
#include <random>

#include "formats/compact/compact_layers.h"
#include "formats/files/byte_reader.h"
#include "formats/findings/findings.h"
#include "tests/fuzz/feeds.h"
#include "tests/fuzz/small_seeds.h"

namespace imgmesh::fuzz {
namespace {

// What a container would say about the stream: the size of its first part, and as many levels as it has.
ExpectedLayers expected_of(std::span<const std::uint8_t> bytes) {
    const ByteReader in(bytes, ByteOrder::kLittle);
    const std::size_t size_at = 11 + in.number_at(8, 1);
    const std::uint32_t width = in.number_at(size_at, 4), height = in.number_at(size_at + 4, 4);
    ExpectedLayers expected{7, 5, {}, {}, true};
    if (width > 0 && height > 0 && std::uint64_t{width} * height <= 1 << 18)
        expected = {static_cast<int>(width), static_cast<int>(height), {}, {}, true};
    const std::uint32_t levels = std::min(in.number_at(6, 2), 4u);
    for (std::uint32_t k = 0; k < levels; ++k) expected.parts.push_back(cat("lod", k));
    return expected;
}

// Waves, noise or leaps.
CompactPart part(const std::string& name, int width, int height, unsigned kind) {
    std::mt19937 random(kind);
    CompactPart part{name, {}, kind % 2 ? WeightPrecision::kHalf : WeightPrecision::kFloat, {}, {}};
    Displacements& map = part.map;
    map.width = width;
    map.height = height;
    map.steps = 8 << kind % 3;
    if (kind % 2) map.inside = Mask(map, 1);
    if (kind == 3) part.visits.assign(map.pixel_count(), 3);
    if (kind > 0) part.topology.assign(64, '7');
    for (std::size_t i = 0; i < map.pixel_count(); ++i) {
        const bool outside = kind % 2 && random() % 9 == 0;
        const double noise = random() % 50 == 0 ? 3000 : static_cast<double>(random() % (1 + 3 * kind));
        const auto of = [&](double value) {
            return outside ? std::int16_t{0} : static_cast<std::int16_t>(value);
        };
        map.dx.push_back(of(9 * std::sin(0.1 * map.x_of(i)) + noise));
        map.dy.push_back(of(5 * std::cos(0.2 * map.y_of(i)) - noise));
        if (outside) map.inside[i] = 0;
    }
    return part;
}

}  // namespace

std::vector<Bytes> compact_seeds() {
    std::vector<Bytes> all;
    for (const unsigned kind : {0u, 1u, 2u})
        all.push_back(encode_compact_layers({part("lod0", 23, 17, kind + 1), part("lod1", 23, 17, kind)}));
    all.push_back(encode_compact_layers({part("lod0", 1, 30, 0)}));
    return all;
}

bool feed_compact(std::span<const std::uint8_t> bytes) {
    const ExpectedLayers expected = expected_of(bytes);
    std::vector<CompactPart> parts;
    std::string_view code;
    try {
        parts = decode_compact_layers(bytes, expected);
    } catch (const FindingError& error) {
        code = error.code();
    }
    Findings findings = Findings::collecting();
    try {
        decode_compact_layers(bytes, expected, findings);
    } catch (const FindingError& error) {
        if (code != error.code())
            throw std::logic_error("reader and validator disagree about the first error");
        return false;
    }
    if ((findings.errors() > 0) != !code.empty()) throw std::logic_error("reader and validator disagree");
    if (!code.empty()) return false;
    // What was read is a part like any other.
    const std::vector<CompactPart> again = decode_compact_layers(encode_compact_layers(parts), expected);
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (again[i].map.inside != parts[i].map.inside || again[i].visits != parts[i].visits ||
            again[i].map.dx.size() != parts[i].map.dx.size())
            throw std::logic_error("another map after encoding");
    return true;
}

}  // namespace imgmesh::fuzz
