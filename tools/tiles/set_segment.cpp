#include "tools/tiles/set_segment.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "formats/export/label_files.h"
#include "formats/export/label_tiff.h"
#include "formats/files/extension.h"
#include "libcore/base/error.h"
#include "libcore/base/index.h"
#include "libcore/segment/segment_parts.h"
#include "tools/common/choices.h"
#include "tools/common/memory.h"
#include "tools/common/names.h"
#include "tools/common/output.h"
#include "tools/common/targets.h"
#include "tools/common/text.h"
#include "tools/tiles/set_input.h"

namespace imgmesh {
namespace {

// A pixel of a tile takes this while the tile is read and segmented, as that of a container does
// (docs/limits.md) [bytes].
constexpr double kTileBytes = 120;

void check_whole(const SegmentOptions& o) {
    const std::pair<const char*, bool> options[] = {{"--superpixels", o.params.superpixels.has_value()},
                                                    {"--image", !o.image.empty()},
                                                    {"--outlines", !o.outlines.empty()},
                                                    {"--flat", !o.flat.empty()},
                                                    {"--colors", !o.colors.empty()},
                                                    {"--svg", !o.svg.empty()},
                                                    {"--ucm", !o.ucm.empty()},
                                                    {"--report", !o.report.empty()},
                                                    {"--mesh", !o.mesh.empty()},
                                                    {"--mask", !o.mask.empty()}};
    for (const auto& [name, is_given] : options)
        if (is_given)
            throw Error(
                ErrorKind::kBadArgument,
                cat(name, ": ", o.input, " is a tile set, of which regions can be had as labels alone"));
}

// Each tile owns its pixels but those of lines that the next ones share.
PartGrid parts_of(const TileGrid& grid, int level) {
    const GridSize size = level_size(grid, level);
    PartGrid parts;
    for (int column = 0; column < grid.columns(level); ++column)
        parts.x.push_back(own_level_rect(grid, {level, column, 0}).left);
    for (int row = 0; row < grid.rows(level); ++row)
        parts.y.push_back(own_level_rect(grid, {level, 0, row}).top);
    parts.x.push_back(size.width);
    parts.y.push_back(size.height);
    return parts;
}

// Fills pixels of a part from a tile before it, where the part has none: as a mask or a missing tile leaves
// them. `line` is what both have of the part; from (left, top) on the tile has the same pixels.
void fill_line(PicturePart& part, const PixelRect& line, const Level& level, int left, int top, Id& faces) {
    const FeatureImage luv = reconstruct_luv(level);
    for (int y = line.top; y < line.bottom; ++y)
        for (int x = line.left; x < line.right; ++x) {
            PixelCoord& pixel = part.map.at(x, y);
            const std::size_t there = level.map.index(left + x - line.left, top + y - line.top);
            if (pixel.face != kNone || level.map[there].face == kNone) continue;
            pixel = level.map[there];
            pixel.face += faces;
            std::copy_n(luv.pixel(there), 3, part.luv.pixel(x, y));
        }
    faces += as_id(level.mesh.faces.size());
}

bool has_gap(const PixelMap& map, const PixelRect& rect) {
    for (int y = rect.top; y < rect.bottom; ++y)
        for (int x = rect.left; x < rect.right; ++x)
            if (map.at(x, y).face == kNone) return true;
    return false;
}

// The pixels that a tile owns. Those of the lines that it shares with tiles before it belong to the last tile
// that has a face for them (docs/tile-sets.md).
PicturePart part_of(const SetInput& set, const TileName& tile) {
    const PixelRect own = own_level_rect(set.grid(), tile);
    const GridSize size{own.width(), own.height()};
    PicturePart part{{size.width, size.height, std::vector<PixelCoord>(size.pixel_count())},
                     {size.width, size.height, 3, std::vector<float>(3 * size.pixel_count())}};
    Id faces = 0;
    if (const MeshImage image = set.read(tile); !image.levels.empty())
        fill_line(part, {0, 0, size.width, size.height}, image.levels[0], 0, 0, faces);
    const std::pair<TileName, PixelRect> before[] = {
        {{tile.level, tile.column - 1, tile.row}, {0, 0, 1, size.height}},
        {{tile.level, tile.column, tile.row - 1}, {0, 0, size.width, 1}},
        {{tile.level, tile.column - 1, tile.row - 1}, {0, 0, 1, 1}}};
    for (const auto& [other, line] : before) {
        if (other.column < 0 || other.row < 0 || !has_gap(part.map, line)) continue;
        const MeshImage image = set.read(other);
        if (image.levels.empty()) continue;
        const PixelMap& map = image.levels[0].map;
        fill_line(part, line, image.levels[0], other.column < tile.column ? map.width - 1 : 0,
                  other.row < tile.row ? map.height - 1 : 0, faces);
    }
    const bool is_empty = std::ranges::all_of(part.map, [](const PixelCoord& c) { return c.face == kNone; });
    return is_empty ? PicturePart{} : part;
}

}  // namespace

Report segment_set(const SegmentOptions& o, Context& context) {
    check_whole(o);
    check_output(o.output, context.overwrite);
    context.progress(0, "read");
    const SetInput set = open_set(o.input, o.level, o.limits, context);
    const TileGrid grid = set.grid();
    if (split_names(set.source(o.level).channel_names).color.empty())
        throw Error(ErrorKind::kUnsupported, cat(o.input, ": has no colour"));
    const GridSize size = level_size(grid, o.level);
    const std::string extension = lower_extension(o.output);
    const bool streams = extension == ".tif" || extension == ".tiff";
    const double pixels = double(size.width) * size.height;
    const double held = streams ? double(sizeof(Id)) * size.width * (grid.step() + 1) : 12 * pixels;
    const SegmentParams params = params_of(o);
    const PartGrid parts = parts_of(grid, o.level);
    context.memory.take(cat(o.input, ": labels of ", size.width, "x", size.height, " pixels"),
                        kProgramMemory + held + part_memory(parts, params) +
                            kTileBytes * (grid.step() + 1.0) * (grid.step() + 1.0));
    std::int64_t tiles = 0;
    for (const TileRecord& record : set.index.tiles)
        tiles += record.tile.level == o.level && !record.files.empty();
    const PartSegmentation result =
        segment_parts({parts,
                       [&](int column, int row) {
                           return part_of(set, {o.level, column, row});
                       }},
                      params, [&](double f, std::string_view stage) { context.progress(0.9 * f, stage); });
    std::vector<std::string> missed;
    if (!result.missed.empty()) missed = {cat("--segments: ", result.missed)};
    tell_missed(o.input, missed, o.strict, context.warnings);

    context.progress(0.9, "write");
    const auto each_row = [&](const auto& put) {
        for (int row = 0; row < parts.rows(); ++row) {
            const PixelRect rect = parts.rect(0, row);
            put(result.labels.window({0, rect.top, size.width, rect.bottom}).values);
        }
    };
    if (streams) {
        LabelTiff tiff(o.output, size.width, size.height, context.overwrite);
        each_row([&](const std::vector<Id>& labels) { tiff.put(labels); });
        tiff.commit();
    } else {
        std::vector<Id> all;
        each_row([&](const std::vector<Id>& labels) { all.insert(all.end(), labels.begin(), labels.end()); });
        write_labels(o.output, size.width, size.height, all, context.overwrite);
    }
    const std::vector<std::int64_t> sizes = result.labels.count_pixels(result.count),
                                    spread = result.labels.count_parts(result.count);
    const auto [least, most] = std::ranges::minmax_element(sizes);
    const std::vector<Merge>& merges = result.hierarchy.merges;
    Report report = {
        {"input", o.input},
        {"output", o.output},
        {"level", o.level},
        {"distance", name_of(distance_choices(), params.distance)},
        {"width", size.width},
        {"height", size.height},
        {"tiles", tiles},
        {"cells", result.cells},
        {"regions", result.count},
        {"joined", std::ranges::count_if(spread, [](std::int64_t parts_with) { return parts_with > 1; })},
        {"min_pixels", *least},
        {"max_pixels", *most},
        {"merged_up_to", result.merges == 0 ? 0.0f : merges[result.merges - 1].height}};
    if (result.merges < merges.size()) report["next_merge"] = merges[result.merges].height;
    report.update(target_report(missed));
    return report;
}

}  // namespace imgmesh
