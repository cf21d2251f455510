#include <algorithm>
#include <utility>

#include "formats/compact/band_decode.h"
#include "formats/compact/compact_bands.h"
#include "formats/compact/compact_header.h"
#include "formats/compact/compact_layers.h"
#include "formats/compact/plane_blocks.h"
#include "formats/findings/findings.h"
#include "libcore/base/error.h"
#include "libcore/base/index.h"
#include "libcore/base/parallel.h"

namespace imgmesh {

struct CompactStream::Coded {
    std::vector<CompactHeader> headers;
    std::vector<std::unique_ptr<const compact::DecodeTables>> tables;
};

CompactStream::CompactStream(std::span<const std::uint8_t> bytes, const ExpectedLayers& expected,
                             Findings& findings)
    : coded_(new Coded{read_compact_headers(bytes, expected, findings), {}}) {
    for (CompactHeader& h : coded_->headers) {
        std::unique_ptr<const compact::DecodeTables> tables;
        if (const std::optional<compact::BandTables> read = compact::read_tables(h.tables)) {
            tables = std::make_unique<const compact::DecodeTables>(*read);
        } else if (!h.bands.empty()) {
            findings.add("layers.header", cat("the tables of part ", h.name, " are broken"), at_part(h.name));
            h.bands.clear();
        }
        coded_->tables.push_back(std::move(tables));
        parts_.push_back({h.name, h.steps, h.band_rows, as_int(h.bands.size()), h.precision, h.has_mask,
                          h.has_visits, h.topology});
    }
}
CompactStream::~CompactStream() = default;
CompactStream::CompactStream(CompactStream&&) noexcept = default;

void CompactStream::decode(std::size_t part, int band, const CompactRows& rows) const {
    decode(part, band, {&rows, 1});
}

void CompactStream::decode(std::size_t part, int first, std::span<const CompactRows> bands) const {
    const CompactHeader& header = coded_->headers[part];
    compact::CodedBand coded[2];
    for (std::size_t i = 0; i < bands.size(); ++i) {
        const std::size_t band = as_index(first) + i;
        const CompactRows& rows = bands[i];
        std::span<const std::uint8_t> bytes = header.bands[band];
        if ((header.has_mask && !take_mask(bytes, rows.inside, header.width)) ||
            (header.has_visits && !take_visits(bytes, rows.visits)))
            refuse("layers.data", cat("the mask or the visits of part ", header.name, " are broken"),
                   at_part(header.name));
        coded[i] = {bytes, header.width, header.rows(band), rows.dx, rows.dy, rows.inside};
    }
    if (!compact::decode_bands(coded[0], bands.size() > 1 ? &coded[1] : nullptr, *coded_->tables[part]))
        refuse("layers.data",
               cat("the rows from ", first * header.band_rows, " on of part ", header.name, " are broken"),
               at_part(header.name));
}

namespace {

CompactPart decode_part(const CompactStream& stream, std::size_t which, const ExpectedLayers& expected) {
    const CompactStream::Part& in = stream.parts()[which];
    CompactPart part{in.name, {}, in.precision, {}, in.topology};
    Displacements& map = part.map;
    map.width = expected.width;
    map.height = expected.height;
    map.steps = in.steps;
    const std::size_t pixels = map.pixel_count();
    map.dx.resize(pixels);
    map.dy.resize(pixels);
    if (in.has_mask) map.inside = Mask(map);
    if (in.has_visits) part.visits.resize(pixels);
    const auto rows_of = [&](int band) {
        const std::size_t begin = map.row_begin(band * in.band_rows),
                          count = std::min(pixels - begin, as_index(in.band_rows) * as_index(map.width));
        const auto rows = [&](auto& all) {
            return all.empty() ? std::span(all) : std::span(all).subspan(begin, count);
        };
        return CompactRows{rows(map.dx), rows(map.dy), rows(map.inside.values), rows(part.visits)};
    };
    parallel_blocks(0, in.bands, 2, [&](int first, int last) {
        std::vector<CompactRows> bands;
        for (int band = first; band < last; ++band) bands.push_back(rows_of(band));
        stream.decode(which, first, bands);
    });
    return part;
}

// Checks the mask, and drops one that masks nothing.
void finish_part(CompactPart& part, bool may_have_mask, Findings& findings) {
    Mask& inside = part.map.inside;
    const auto outside = std::ranges::find(inside.values, 0);
    const bool all_inside = outside == inside.values.end();
    if (!may_have_mask && !all_inside) {
        const auto pixel = static_cast<std::size_t>(outside - inside.values.begin());
        Place place = at_part(part.name);
        place.pixel = {pixel % as_index(part.map.width), pixel / as_index(part.map.width)};
        findings.add("layers.mask", cat("pixels of ", part.name, " are outside, but the image has no mask"),
                     place);
    }
    if (may_have_mask && all_inside)
        findings.add("layers.mask_unused", cat("every pixel of ", part.name, " has a face"),
                     at_part(part.name));
    if (all_inside) inside = {};
    if (part.topology.empty())
        findings.add("layers.unbound", cat("part ", part.name, " has no topology"), at_part(part.name));
    if (!part.visits.empty() && part.name != "lod0")
        findings.add("layers.visits", cat("part ", part.name, " has visits"), at_part(part.name));
}

}  // namespace

std::vector<CompactPart> decode_compact_layers(std::span<const std::uint8_t> bytes,
                                               const ExpectedLayers& expected, Findings& findings) {
    const CompactStream stream(bytes, expected, findings);
    std::vector<CompactPart> parts(expected.parts.size());
    for (std::size_t which = 0; which < parts.size(); ++which) {
        parts[which].name = expected.parts[which];
        if (stream.parts()[which].bands == 0) continue;
        const std::size_t before = findings.errors();
        try {
            CompactPart part = decode_part(stream, which, expected);
            finish_part(part, expected.has_mask, findings);
            if (findings.errors() == before) parts[which] = std::move(part);
        } catch (const FindingError& error) {
            if (!findings.collects()) throw;
            findings.add("layers.data", error.what(), error.place());
        }
    }
    return parts;
}

std::vector<CompactPart> decode_compact_layers(std::span<const std::uint8_t> bytes,
                                               const ExpectedLayers& expected) {
    Findings findings = Findings::strict();
    return decode_compact_layers(bytes, expected, findings);
}

}  // namespace imgmesh
