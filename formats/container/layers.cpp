#include "formats/container/layers.h"

#include <deque>
#include <utility>

#include "formats/compact/compact_layers.h"
#include "formats/findings/findings.h"
#include "libcore/base/error.h"
#include "libcore/mesh/locate_map.h"

namespace imgmesh {
namespace {

std::vector<std::uint8_t> encode_compact(const std::vector<LayerSource>& levels) {
    std::deque<Displacements> places;
    std::vector<CompactView> parts;
    for (const auto& [view, mesh] : levels) {
        std::optional<Displacements> found = displacements_of(*mesh, *view.map);
        if (!found)
            throw Error(ErrorKind::kUnsupported,
                        cat("the pixel map of ", view.name,
                            " has no compact form, as its pixels do not lie on a grid: it was tracked, bent "
                            "or stretched for a texture, or is of an older version; an EXR holds it"));
        places.push_back(*std::move(found));
        parts.push_back({view.name, &places.back(), view.map->precision, view.visits, view.topology});
    }
    return encode_compact_layers(parts);
}

}  // namespace

std::vector<std::uint8_t> encode_layers(LayerLayout layout, const std::vector<LayerSource>& levels) {
    if (layout == LayerLayout::kCompact) return encode_compact(levels);
    std::vector<LayerView> parts;
    for (const LayerSource& level : levels) parts.push_back(level.view);
    return encode_exr_layers(parts);
}

StoredLayers::StoredLayers(LayerLayout layout, std::span<const std::uint8_t> bytes,
                           const ExpectedLayers& expected, Findings& findings) {
    if (layout == LayerLayout::kExr) {
        parts_ = decode_exr_layers(bytes, expected, findings);
        return;
    }
    for (CompactPart& part : decode_compact_layers(bytes, expected, findings)) {
        LayerPart& out = parts_.emplace_back(
            LayerPart{std::move(part.name), {}, std::move(part.visits), std::move(part.topology)});
        out.map.precision = part.precision;
        places_.push_back(std::move(part.map));
    }
}

PixelMap StoredLayers::take_map(std::size_t level, const BaseMesh& mesh, Findings& findings) {
    LayerPart& part = parts_[level];
    if (places_.empty()) return std::move(part.map);
    const Displacements places = std::move(places_[level]);
    if (places.dx.empty() || mesh.faces.empty()) return {};
    try {
        LocatedMap located = locate_map(mesh, places, part.map.precision);
        if (!located.lost) return std::move(located.map);
        const int x = places.x_of(*located.lost), y = places.y_of(*located.lost);
        Place place = at_part(part.name);
        place.pixel = {x, y};
        findings.add("layers.data", cat("pixel (", x, ", ", y, ") of ", part.name, " lies on no face"),
                     place);
    } catch (const Error& error) {
        findings.add("layers.data", cat(part.name, ": ", error.what()), at_part(part.name));
    }
    return {};
}

}  // namespace imgmesh
