#include "formats/exr/exr_part_checks.h"

#include <string_view>

#include "formats/findings/findings.h"
#include "libcore/base/error.h"
#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

constexpr unsigned kMaxTileSide = 1024;

void check_channels(const ExrPartHeader& header, const std::string& name, Findings& findings) {
    bool face = false, u = false, v = false;
    for (const ExrPartChannel& c : header.channels) {
        const std::string& channel = c.name;
        const bool is_weight = channel == kU || channel == kV;
        const bool is_id = channel == kFace || channel == kVisits;
        const bool right_type = is_id ? c.type == ExrSample::kUint : is_weight && c.type != ExrSample::kUint;
        const Place place = at_part(name, channel);
        if (!right_type || c.x_sampling != 1 || c.y_sampling != 1)
            findings.add(
                "layers.channels",
                cat("channel ", channel, " of part ", name, " is unknown, of another type or subsampled"),
                place);
        if (channel == kVisits && name != "lod0")
            findings.add("layers.visits", cat("part ", name, " has ", kVisits), place);
        face = face || channel == kFace;
        u = u || channel == kU;
        v = v || channel == kV;
    }
    if (!face || !u || !v)
        findings.add("layers.missing", cat("part ", name, " lacks one of ", kFace, ", ", kU, ", ", kV),
                     at_part(name));
}

}  // namespace

void check_part_header(const ExrPartHeader& header, const std::string& name, const ExpectedLayers& expected,
                       Findings& findings) {
    const Place place = at_part(name);
    if (header.type && *header.type != "scanlineimage" && *header.type != "tiledimage")
        findings.add("layers.type", cat("part ", name, " is of type ", *header.type), place);
    if (header.tiles) {
        const ExrTiles& tiles = *header.tiles;
        if (!tiles.has_one_level || tiles.width > kMaxTileSide || tiles.height > kMaxTileSide)
            findings.add("layers.tiles",
                         cat("part ", name, " has tiles of ", tiles.width, "x", tiles.height,
                             " or of several levels, at most ", kMaxTileSide, " and one"),
                         place);
    }
    const ExrWindow window{0, 0, expected.width - 1, expected.height - 1};
    Repeated windows(findings, "layers.window");
    for (const ExrWindow& found : {header.data, header.shown})
        if (found != window)
            windows.hit([&] {
                return std::pair(
                    cat("part ", name, " has the window (", found.min_x, ",", found.min_y, ")-(", found.max_x,
                        ",", found.max_y, "), expected (0,0)-(", window.max_x, ",", window.max_y, ")"),
                    place);
            });
    const int compression = header.compression;
    if (compression != kExrUncompressed && compression != kExrZips && compression != kExrZip)
        findings.add("layers.compression", cat("part ", name, " has compression ", compression), place);
    check_channels(header, name, findings);
}

namespace {

// What a quick check of all pixels finds.
struct Glance {
    bool sound = true, half_grid = true, any_outside = false;
};

// Checks the rows [first, last). Makes negative zeros positive, and changes nothing else.
Glance glance(PixelMap& map, int first, int last, std::uint64_t faces, bool has_mask) {
    bool sound = true, half_grid = true, any_outside = false;
    for (int y = first; y < last; ++y)
        for (PixelCoord& c : map.row(y)) {
            const bool outside = c.face == kNone;
            sound &= in_simplex(c) & on_grid(c, kFloatWeightStep) &
                     (outside ? has_mask & (c.u == 0) & (c.v == 0) : c.face < faces);
            half_grid &= on_grid(c, kHalfWeightStep);
            any_outside |= outside;
            c.u += 0.0f;
            c.v += 0.0f;
        }
    return {sound, half_grid, any_outside};
}

Glance glance(PixelMap& map, std::uint64_t faces, bool has_mask) {
    constexpr int kGrain = 32;
    std::vector<Glance> blocks(static_cast<std::size_t>((map.height + kGrain - 1) / kGrain));
    parallel_blocks(0, map.height, kGrain, [&](int first, int last) {
        blocks[static_cast<std::size_t>(first / kGrain)] = glance(map, first, last, faces, has_mask);
    });
    Glance all;
    for (const Glance& g : blocks) {
        all.sound &= g.sound;
        all.half_grid &= g.half_grid;
        all.any_outside |= g.any_outside;
    }
    return all;
}

}  // namespace

// Checks the pixels and rounds weights of any origin to the grid. Nearly all maps are sound, so pixels are
// examined one by one only if the quick check has found something.
void finish_part(LayerPart& part, bool stored_as_half, std::uint64_t faces, bool has_mask,
                 Findings& findings) {
    const Glance first = glance(part.map, faces, has_mask);
    bool all_on_half_grid = stored_as_half && first.half_grid, any_outside = first.any_outside;
    const auto width = static_cast<std::size_t>(part.map.width);
    const auto where = [&](std::size_t i) { return cat("(", i % width, ",", i / width, ") of ", part.name); };
    const auto place = [&](std::size_t i, const char* channel) {
        Place p = at_part(part.name, channel);
        p.pixel = {i % width, i / width};
        return p;
    };
    Repeated weights(findings, "layers.weights"), mask(findings, "layers.mask"),
        range(findings, "layers.face_range"), grid(findings, "layers.grid");
    for (std::size_t i = 0; i < part.map.size() && !first.sound; ++i) {
        PixelCoord& c = part.map[i];
        if (!in_simplex(c))
            weights.hit([&] {
                return std::pair(cat("weights u = ", c.u, ", v = ", c.v, " at ", where(i),
                                     ", expected u, v >= 0 and u + v <= 1"),
                                 place(i, kU));
            });
        if (c.face == kNone) {
            if (!has_mask)
                mask.hit([&] {
                    return std::pair(cat("no face at ", where(i), ", but the image has no mask"),
                                     place(i, kFace));
                });
            else if (c.u != 0 || c.v != 0)
                mask.hit(
                    [&] { return std::pair(cat("weights outside the mask at ", where(i)), place(i, kU)); });
        } else if (c.face >= faces) {
            range.hit([&] {
                return std::pair(
                    cat("face.id ", c.face, " at ", where(i), ", the mesh has ", faces, " faces"),
                    place(i, kFace));
            });
        }
        const PixelCoord stored = c;
        // For weights on the grid this changes nothing except negative zeros.
        c.u = std::floor(c.u / kFloatWeightStep) * kFloatWeightStep + 0.0f;
        c.v = std::floor(c.v / kFloatWeightStep) * kFloatWeightStep + 0.0f;
        if (c != stored)
            grid.hit([&] { return std::pair(cat("weights off the grid at ", where(i)), place(i, kU)); });
        all_on_half_grid = all_on_half_grid && on_grid(c, kHalfWeightStep);
    }
    if (has_mask && !any_outside)
        findings.add("layers.mask_unused", cat("every pixel of ", part.name, " has a face"),
                     at_part(part.name, kFace));
    part.map.precision = all_on_half_grid ? WeightPrecision::kHalf : WeightPrecision::kFloat;
}

}  // namespace imgmesh
