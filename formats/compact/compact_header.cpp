#include "formats/compact/compact_header.h"

#include <algorithm>
#include <limits>

#include "formats/compact/compact_layers.h"
#include "formats/files/byte_reader.h"
#include "formats/findings/findings.h"
#include "libcore/base/error.h"
#include "libcore/base/index.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Flags of a part.
constexpr unsigned kHasMask = 1, kHasVisits = 2, kHasTopology = 4, kHasHalves = 8, kAllFlags = 15;
constexpr std::size_t kHashBytes = 32;

void put_number(Bytes& out, std::size_t number, int count) {
    for (int i = 0; i < count; ++i) out.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
}

void put_bytes(Bytes& out, std::span<const std::uint8_t> bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
}

int digit_of(char c) {
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

void put_topology(Bytes& out, const std::string& topology) {
    if (topology.size() != 2 * kHashBytes ||
        std::ranges::any_of(topology, [](char c) { return digit_of(c) < 0; }))
        throw Error(ErrorKind::kInternal, cat("the topology ", topology, " is no hash"));
    for (std::size_t i = 0; i < topology.size(); i += 2)
        out.push_back(static_cast<std::uint8_t>(16 * digit_of(topology[i]) + digit_of(topology[i + 1])));
}

std::string topology_of(std::span<const std::uint8_t> hash) {
    std::string text;
    for (const std::uint8_t byte : hash)
        text += {"0123456789abcdef"[byte / 16], "0123456789abcdef"[byte % 16]};
    return text;
}

// Reads the header of a part, and finds where its tables and bands lie.
CompactHeader read_header(ByteReader& in, const ExpectedLayers& expected) {
    CompactHeader header;
    header.name = text_of(in.take(in.number(1)));
    const Place place = at_byte("layers", in.position());
    header.steps = static_cast<int>(in.number(1));
    const unsigned flags = in.number(1);
    if ((header.steps != 8 && header.steps != 16 && header.steps != 32) || flags > kAllFlags)
        refuse("layers.header",
               cat("a part has ", header.steps, " steps in a pixel and the flags ", flags,
                   ", expected 8, 16 or 32 and at most ", kAllFlags),
               place);
    header.has_mask = flags & kHasMask;
    header.has_visits = flags & kHasVisits;
    header.precision = flags & kHasHalves ? WeightPrecision::kHalf : WeightPrecision::kFloat;
    const std::uint32_t width = in.number(4), height = in.number(4), rows = in.number(4);
    if (std::cmp_not_equal(width, expected.width) || std::cmp_not_equal(height, expected.height))
        refuse("layers.window",
               cat("a part has ", width, "x", height, " pixels, expected ", expected.width, "x",
                   expected.height),
               place);
    header.width = expected.width;
    header.height = expected.height;
    if (rows == 0 || rows > height)
        refuse("layers.header", cat("a part has bands of ", rows, " rows, expected 1 to ", height), place);
    header.band_rows = static_cast<int>(rows);
    if (flags & kHasTopology) header.topology = topology_of(in.take(kHashBytes));
    header.tables = in.take(in.number(4));
    const std::size_t count = (height + rows - std::size_t{1}) / rows;
    ByteReader lengths(in.take(4 * count), ByteOrder::kLittle);  // there before memory is taken for bands
    header.bands.reserve(count);
    for (std::size_t band = 0; band < count; ++band) {
        const std::size_t pixels = as_index(header.rows(band)) * as_index(width), length = lengths.number(4);
        if (length < pixels / kPixelsOfByte)
            refuse("layers.size", cat("a band of ", pixels, " pixels has ", length, " bytes"), place);
        header.bands.push_back(in.take(length));
    }
    return header;
}

}  // namespace

int CompactHeader::rows(std::size_t band) const {
    return std::min(band_rows, height - as_int(band) * band_rows);
}

int band_rows_of(const GridSize& size) {
    // A band's first row takes about twice the bits of others: with 64 rows, 1.5 % of the stream. Bands that
    // take a thread 3 ms leave enough of them to all threads. Their number is even, for they are decoded two
    // at a time.
    constexpr std::size_t kRows = 64, kPixels = std::size_t{1} << 17;
    const std::size_t height = as_index(size.height), wanted = size.pixel_count() / kPixels,
                      bands = std::clamp(wanted + wanted % 2, std::size_t{1},
                                         std::max<std::size_t>(1, height / kRows));
    return as_int((height + bands - 1) / bands);
}

void put_stream_header(Bytes& out, std::size_t parts) {
    put_bytes(out, kCompactMagic);
    put_number(out, kCompactMajor, 1);
    put_number(out, kCompactMinor, 1);
    put_number(out, parts, 2);
}

void put_part(Bytes& out, const CompactHeader& header) {
    if (header.name.size() > 255) throw Error(ErrorKind::kInternal, "the name of a part is too long");
    put_number(out, header.name.size(), 1);
    out.insert(out.end(), header.name.begin(), header.name.end());
    put_number(out, as_index(header.steps), 1);
    const bool halves = header.precision == WeightPrecision::kHalf;
    put_number(out,
               (header.has_mask ? kHasMask : 0) | (header.has_visits ? kHasVisits : 0) |
                   (header.topology.empty() ? 0 : kHasTopology) | (halves ? kHasHalves : 0),
               1);
    for (const int number : {header.width, header.height, header.band_rows})
        put_number(out, as_index(number), 4);
    if (!header.topology.empty()) put_topology(out, header.topology);
    for (const std::span<const std::uint8_t> band : header.bands)
        if (band.size() > std::numeric_limits<std::uint32_t>::max())
            throw Error(ErrorKind::kUnsupported,
                        cat("a compact stream cannot hold rows of ", header.width, " such pixels"));
    put_number(out, header.tables.size(), 4);
    put_bytes(out, header.tables);
    for (const std::span<const std::uint8_t> band : header.bands) put_number(out, band.size(), 4);
    for (const std::span<const std::uint8_t> band : header.bands) put_bytes(out, band);
}

bool is_compact_stream(std::span<const std::uint8_t> bytes) {
    return bytes.size() >= sizeof kCompactMagic &&
           std::ranges::equal(bytes.first(sizeof kCompactMagic), kCompactMagic);
}

std::vector<CompactHeader> read_compact_headers(std::span<const std::uint8_t> bytes,
                                                const ExpectedLayers& expected, Findings& findings) {
    if (!is_compact_stream(bytes)) refuse("layers.magic", "not a compact stream", at_byte("layers", 0));
    const std::uint64_t pixels = static_cast<std::uint64_t>(expected.width) *
                                 static_cast<std::uint64_t>(expected.height) * expected.parts.size();
    if (pixels / kPixelsOfByte > bytes.size())
        refuse("layers.size",
               cat("the compact stream has ", bytes.size(), " bytes, too few for ", expected.parts.size(),
                   " levels of ", expected.width, "x", expected.height, " pixels"));
    std::vector<CompactHeader> headers(expected.parts.size());
    ByteReader in(bytes, ByteOrder::kLittle);
    try {
        in.take(sizeof kCompactMagic);
        const std::uint32_t major = in.number(1);
        in.number(1);  // later minor versions are read all the same
        if (major != kCompactMajor)
            refuse("layers.version",
                   cat("the compact stream has version ", major, ", expected ", kCompactMajor),
                   at_byte("layers", sizeof kCompactMagic));
        const std::uint32_t parts = in.number(2);
        if (parts != expected.parts.size())
            refuse("layers.parts",
                   cat("the compact stream has ", parts, " parts, expected ", expected.parts.size()));
        for (std::uint32_t i = 0; i < parts; ++i) {
            CompactHeader header = read_header(in, expected);
            const auto found = std::ranges::find(expected.parts, header.name);
            if (found == expected.parts.end()) continue;
            CompactHeader& place = headers[as_index(found - expected.parts.begin())];
            if (!place.bands.empty())
                refuse("layers.parts", cat("the compact stream has part ", header.name, " twice"),
                       at_part(header.name));
            place = std::move(header);
        }
    } catch (const EndOfBytes& end) {
        refuse("layers.header", "the compact stream ends too early", at_byte("layers", end.position));
    }
    if (in.left() > 0)
        refuse("layers.header", cat(in.left(), " bytes after the end of the compact stream"),
               at_byte("layers", in.position()));
    for (std::size_t i = 0; i < headers.size(); ++i)
        if (headers[i].bands.empty()) {
            headers[i].name = expected.parts[i];
            findings.add("layers.parts", cat("the compact stream has no part ", expected.parts[i]),
                         at_part(expected.parts[i]));
        }
    return headers;
}

}  // namespace imgmesh
