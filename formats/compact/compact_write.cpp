#include <algorithm>
#include <array>

#include "formats/compact/band_encode.h"
#include "formats/compact/band_fit.h"
#include "formats/compact/compact_header.h"
#include "formats/compact/compact_layers.h"
#include "formats/compact/plane_blocks.h"
#include "libcore/base/error.h"
#include "libcore/base/index.h"
#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kFinest = 32, kCoarsest = 8;

void check_part(const CompactView& part) {
    const Displacements& map = *part.map;
    const std::size_t pixels = map.pixel_count();
    const bool sizes = map.width > 0 && map.height > 0 && map.dx.size() == pixels &&
                       map.dy.size() == pixels && (map.inside.empty() || map.inside.size() == pixels) &&
                       (part.visits.empty() || part.visits.size() == pixels);
    if (!sizes || (map.steps != kCoarsest && map.steps != 16 && map.steps != kFinest))
        throw Error(ErrorKind::kInternal,
                    cat("cannot store the displacements of ", part.name, ": ", map.width, "x", map.height,
                        " pixels, ", map.steps, " steps, or sizes that disagree"));
    if (map.inside.empty()) return;
    for (std::size_t i = 0; i < pixels; ++i)
        if (!map.inside.values[i] && (map.dx[i] != 0 || map.dy[i] != 0))
            throw Error(ErrorKind::kInternal, cat("a pixel outside the mask of ", part.name, " is moved"));
}

// By how many bits the displacements can be shifted, so that equal maps give equal bytes.
int common_shift(const Displacements& map) {
    unsigned bits = 0;
    for (const std::vector<std::int16_t>* d : {&map.dx, &map.dy})
        for (const std::int16_t value : *d) {
            bits |= static_cast<unsigned>(value);
            if ((bits & 1) != 0) return 0;
        }
    int shift = 0;
    while ((map.steps >> shift) > kCoarsest && ((bits >> shift) & 1) == 0) ++shift;
    return shift;
}

void add(compact::TokenCounts& sum, const compact::TokenCounts& counts) {
    auto* to = &sum[0][0][0][0];
    const auto* from = &counts[0][0][0][0];
    for (std::size_t i = 0; i < sizeof sum / sizeof *to; ++i) to[i] += from[i];
}

// The map with the coarsest steps.
Displacements coarsened(const Displacements& map, int shift) {
    Displacements coarse = map;
    coarse.steps = map.steps >> shift;
    for (std::vector<std::int16_t>* d : {&coarse.dx, &coarse.dy})
        for (std::int16_t& value : *d) value = static_cast<std::int16_t>(value >> shift);
    return coarse;
}

// Encodes a part whose steps are the coarsest.
void put_map(Bytes& out, const CompactView& part, const Displacements& map) {
    CompactHeader header;
    static_cast<GridSize&>(header) = map;
    header.name = part.name;
    header.steps = map.steps;
    header.band_rows = band_rows_of(map);
    header.precision = part.precision;
    header.has_mask = std::ranges::find(map.inside.values, 0) != map.inside.values.end();
    header.has_visits = !part.visits.empty();
    header.topology = part.topology;
    const std::array<compact::Taps, 2> taps{compact::fit_taps(map.dx, map.width, map.height),
                                            compact::fit_taps(map.dy, map.width, map.height)};
    const auto rows_of = [&](const auto& all, int band) {
        const std::size_t first = map.row_begin(band * header.band_rows),
                          pixels = as_index(header.rows(as_index(band))) * as_index(map.width);
        return std::span(all).subspan(first, pixels);
    };
    const int bands = (map.height + header.band_rows - 1) / header.band_rows;
    std::vector<compact::BandTokens> tokens(as_index(bands));
    const auto for_bands = [&](const auto& body) {
        parallel_blocks(0, bands, 1, [&](int first, int last) {
            for (int band = first; band < last; ++band) body(band);
        });
    };
    for_bands([&](int band) {
        compact::Band rows{
            map.width, header.rows(as_index(band)), rows_of(map.dx, band), rows_of(map.dy, band), {}};
        if (header.has_mask) rows.inside = rows_of(map.inside.values, band);
        tokens[as_index(band)] = compact::band_tokens(rows, taps);
    });
    compact::TokenCounts counts{};
    for (const compact::BandTokens& band : tokens) add(counts, band.counts);
    const Bytes table_bytes = compact::table_bytes(taps, counts);
    const compact::BandTables tables = compact::read_tables(table_bytes).value();
    std::vector<Bytes> coded(as_index(bands));
    for_bands([&](int band) {
        Bytes& bytes = coded[as_index(band)];
        if (header.has_mask) put_mask(bytes, rows_of(map.inside.values, band), map.width);
        if (header.has_visits) put_visits(bytes, rows_of(part.visits, band));
        compact::put_band(bytes, tokens[as_index(band)], tables);
        const std::size_t pixels = as_index(header.rows(as_index(band))) * as_index(map.width);
        bytes.resize(std::max(bytes.size(), pixels / kPixelsOfByte));
        tokens[as_index(band)] = {};
    });
    header.tables = table_bytes;
    header.bands.assign(coded.begin(), coded.end());
    put_part(out, header);
}

void put_view(Bytes& out, const CompactView& part) {
    const int shift = common_shift(*part.map);
    if (shift == 0)
        put_map(out, part, *part.map);
    else
        put_map(out, part, coarsened(*part.map, shift));
}

}  // namespace

std::vector<std::uint8_t> encode_compact_layers(const std::vector<CompactPart>& parts) {
    std::vector<CompactView> views;
    for (const CompactPart& part : parts)
        views.push_back({part.name, &part.map, part.precision, part.visits, part.topology});
    return encode_compact_layers(views);
}

std::vector<std::uint8_t> encode_compact_layers(const std::vector<CompactView>& parts) {
    for (const CompactView& part : parts) check_part(part);
    Bytes bytes;
    put_stream_header(bytes, parts.size());
    for (const CompactView& part : parts) put_view(bytes, part);
    return bytes;
}

}  // namespace imgmesh
