#include <algorithm>

#include "formats/compact/band_coder.h"
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
        for (const std::int16_t value : *d) bits |= static_cast<unsigned>(value);
    int shift = 0;
    while ((map.steps >> shift) > kCoarsest && ((bits >> shift) & 1) == 0) ++shift;
    return shift;
}

std::vector<std::int16_t> shifted(std::span<const std::int16_t> values, int shift) {
    std::vector<std::int16_t> result(values.begin(), values.end());
    for (std::int16_t& value : result) value = static_cast<std::int16_t>(value >> shift);
    return result;
}

Bytes band_bytes(const CompactView& part, const CompactHeader& header, int shift, std::size_t band) {
    const Displacements& map = *part.map;
    const int rows = header.rows(band);
    const std::size_t first = map.row_begin(as_int(band) * header.band_rows),
                      pixels = as_index(rows) * as_index(map.width);
    Bytes bytes;
    std::span<const std::uint8_t> inside;
    if (header.has_mask) {
        inside = std::span(map.inside.values).subspan(first, pixels);
        put_mask(bytes, inside, map.width);
    }
    if (header.has_visits) put_visits(bytes, part.visits.subspan(first, pixels));
    const std::vector<std::int16_t> dx = shifted(std::span(map.dx).subspan(first, pixels), shift),
                                    dy = shifted(std::span(map.dy).subspan(first, pixels), shift);
    const Bytes coded = encode_band({map.width, rows, dx, dy, inside});
    bytes.insert(bytes.end(), coded.begin(), coded.end());
    bytes.resize(std::max(bytes.size(), pixels / kPixelsOfByte));
    return bytes;
}

void put_view(Bytes& out, const CompactView& part) {
    const Displacements& map = *part.map;
    CompactHeader header;
    static_cast<GridSize&>(header) = map;
    header.name = part.name;
    const int shift = common_shift(map);
    header.steps = map.steps >> shift;
    header.band_rows = band_rows_of(map);
    header.precision = part.precision;
    header.has_mask = std::ranges::find(map.inside.values, 0) != map.inside.values.end();
    header.has_visits = !part.visits.empty();
    header.topology = part.topology;
    const int bands = (map.height + header.band_rows - 1) / header.band_rows;
    std::vector<Bytes> coded(as_index(bands));
    parallel_blocks(0, bands, 1, [&](int first, int last) {
        for (int band = first; band < last; ++band)
            coded[as_index(band)] = band_bytes(part, header, shift, as_index(band));
    });
    header.bands.assign(coded.begin(), coded.end());
    put_part(out, header);
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
