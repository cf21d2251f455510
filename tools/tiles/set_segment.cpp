#include "tools/tiles/set_segment.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "formats/export/label_files.h"
#include "formats/export/label_tiff.h"
#include "formats/files/extension.h"
#include "libcore/base/error.h"
#include "libcore/base/index.h"
#include "libcore/segment/join_regions.h"
#include "tools/common/choices.h"
#include "tools/common/memory.h"
#include "tools/common/names.h"
#include "tools/common/output.h"
#include "tools/common/text.h"
#include "tools/tiles/set_input.h"

namespace imgmesh {
namespace {

// A pixel of a tile takes this while the tile is read and segmented, as that of a container does
// (docs/limits.md), and one of the whole picture: its runs of labels [bytes].
constexpr double kTileBytes = 120, kRunBytes = 0.5;

void check_whole(const SegmentOptions& o) {
    const std::pair<const char*, bool> options[] = {{"--segments", o.params.segments || o.params.clearest},
                                                    {"--superpixels", o.params.superpixels.has_value()},
                                                    {"--min-size", o.params.min_size != 1},
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
            throw Error(ErrorKind::kUnsupported, cat(name, ": ", o.input,
                                                     " is a tile set, which is segmented tile by tile, with "
                                                     "--threshold alone"));
}

// As many pixels of a row side by side, with the same label.
struct Run {
    Id label = kNone;
    int pixels = 0;
};

// The regions of a tile: numbers from `first` on among those of all tiles, at its own pixels, row by row.
struct TileRuns {
    PixelRect own;  // in the picture
    std::vector<Run> runs;
};

// The labels of the last pixels of tiles, whose lines their neighbours to the right and below share.
struct SharedLines {
    std::vector<Id> right;                   // of the tile before in the row
    std::map<int, std::vector<Id>> bottoms;  // by column: of the row above
};

std::vector<Id> column_of(const Grid<Id>& labels, int x) {
    std::vector<Id> line;
    for (int y = 0; y < labels.height; ++y) line.push_back(labels.at(x, y));
    return line;
}
std::vector<Id> row_of(const Grid<Id>& labels, int y) {
    std::vector<Id> line;
    for (int x = 0; x < labels.width; ++x) line.push_back(labels.at(x, y));
    return line;
}

// The first pass: the regions of the tiles, and which of them are one.
class TilePass {
  public:
    TilePass(const SetInput& set, const SegmentOptions& o)
        : set_(set), level_(o.level), params_(params_of(o)), grid_(set.grid()), joiner_(params_.threshold) {}

    void run(const Progress& progress) {
        for (int row = 0; row < grid_.rows(level_); ++row) {
            lines_.right.clear();
            for (int column = 0; column < grid_.columns(level_); ++column) {
                progress((row + column / double(grid_.columns(level_))) / grid_.rows(level_), "segment");
                segment_tile({level_, column, row});
            }
        }
    }

    const std::vector<TileRuns>& tiles() const { return tiles_; }
    const RegionJoiner& joiner() const { return joiner_; }
    std::int64_t segmented() const { return segmented_; }
    std::size_t cells() const { return cells_; }
    float merged_up_to() const { return merged_up_to_; }

  private:
    void segment_tile(const TileName& tile) {
        const PixelRect own = own_level_rect(grid_, tile);
        TileRuns& out = tiles_.emplace_back(TileRuns{own, {}});
        const MeshImage image = set_.read(tile);
        if (image.levels.empty()) {
            lines_.right.clear();
            lines_.bottoms.erase(tile.column);
            return;
        }
        const FeatureImage picture = reconstruct_luv(image.levels[0]);
        Segmentation result = segment(image.levels[0], picture, params_);
        LabelImage& labels = result.labels;
        ++segmented_;
        cells_ += result.hierarchy.cells;
        if (result.merges > 0)
            merged_up_to_ = std::max(merged_up_to_, result.hierarchy.merges[result.merges - 1].height);

        std::vector<TileRegion> regions(labels.count);
        const std::vector<RegionFacts> facts = region_facts(labels, picture);
        for (std::size_t i = 0; i < facts.size(); ++i) regions[i].color = facts[i].color;
        const std::int64_t width = level_size(grid_, level_).width;
        for (int y = 0; y < own.height(); ++y)
            for (int x = 0; x < own.width(); ++x)
                if (const Id label = labels.at(x, y); label != kNone && regions[label].pixels++ == 0)
                    regions[label].first = (own.top + y) * width + own.left + x;
        const Id first = joiner_.add(regions);
        for (Id& label : labels.values)
            if (label != kNone) label += first;
        add_runs(out, labels);
        join(tile, labels);
    }

    static void add_runs(TileRuns& out, const Grid<Id>& labels) {
        for (int y = 0; y < out.own.height(); ++y)
            for (int x = 0; x < out.own.width(); ++x) {
                const Id label = labels.at(x, y);
                if (x == 0 || out.runs.back().label != label) out.runs.push_back({label, 0});
                ++out.runs.back().pixels;
            }
        out.runs.shrink_to_fit();
    }

    void join(const TileName& tile, const Grid<Id>& labels) {
        if (!lines_.right.empty()) joiner_.add_line(lines_.right, column_of(labels, 0));
        if (const auto above = lines_.bottoms.find(tile.column); above != lines_.bottoms.end())
            joiner_.add_line(above->second, row_of(labels, 0));
        lines_.right = column_of(labels, labels.width - 1);
        lines_.bottoms[tile.column] = row_of(labels, labels.height - 1);
    }

    const SetInput& set_;
    int level_;
    SegmentParams params_;
    TileGrid grid_;
    RegionJoiner joiner_;
    SharedLines lines_;
    std::vector<TileRuns> tiles_;  // row by row
    std::int64_t segmented_ = 0;
    std::size_t cells_ = 0;
    float merged_up_to_ = 0;  // of all tiles
};

// Gives a row of tiles the regions' numbers in the whole picture.
std::vector<Id> labels_of_row(std::span<const TileRuns> tiles, int width, const std::vector<Id>& numbers) {
    std::vector<Id> labels(as_index(width) * as_index(tiles.front().own.height()), kNone);
    for (const TileRuns& tile : tiles) {
        int x = 0, y = 0;
        for (const Run& run : tile.runs) {
            const std::size_t at = as_index(y) * as_index(width) + as_index(tile.own.left + x);
            if (run.label != kNone)
                std::fill_n(labels.begin() + static_cast<std::ptrdiff_t>(at), run.pixels, numbers[run.label]);
            x += run.pixels;
            if (x < tile.own.width()) continue;
            x = 0;
            ++y;
        }
    }
    return labels;
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
    context.memory.take(
        cat(o.input, ": labels of ", size.width, "x", size.height, " pixels"),
        kProgramMemory + held + kRunBytes * pixels + kTileBytes * (grid.step() + 1.0) * (grid.step() + 1.0));

    TilePass pass(set, o);
    pass.run([&](double f, std::string_view stage) { context.progress(0.9 * f, stage); });
    const JoinedRegions joined = pass.joiner().finish();

    context.progress(0.9, "write");
    const std::span<const TileRuns> tiles = pass.tiles();
    const std::size_t columns = as_index(grid.columns(o.level));
    const auto each_row = [&](const auto& put) {
        for (std::size_t i = 0; i < tiles.size(); i += columns)
            put(labels_of_row(tiles.subspan(i, columns), size.width, joined.numbers));
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
    const auto [least, most] = std::ranges::minmax_element(joined.pixels);
    return {{"input", o.input},
            {"output", o.output},
            {"level", o.level},
            {"distance", name_of(distance_choices(), params_of(o).distance)},
            {"width", size.width},
            {"height", size.height},
            {"tiles", pass.segmented()},
            {"cells", pass.cells()},
            {"regions", joined.pixels.size()},
            {"joined", joined.across},
            {"min_pixels", *least},
            {"max_pixels", *most},
            {"merged_up_to", pass.merged_up_to()},
            {"target_reached", true}};
}

}  // namespace imgmesh
