#include "tools/tiles/tile_work.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "formats/container/container.h"
#include "formats/files/stale_temporaries.h"
#include "formats/picture/spool.h"
#include "formats/tileset/tile_set_files.h"
#include "formats/tileset/tile_view.h"
#include "formats/tileset/tileset_json.h"
#include "libcore/pipeline/params.h"
#include "libcore/tiles/density.h"
#include "libcore/tiles/sides_of_tile.h"
#include "libcore/tiles/tile_errors.h"
#include "tools/common/in_file.h"
#include "tools/common/output.h"
#include "tools/common/text.h"
#include "tools/tiles/coarse_tile.h"
#include "tools/tiles/threshold_files.h"
#include "tools/tiles/tile_memory.h"
#include "tools/tiles/tile_pixels.h"

namespace imgmesh {
namespace {

// Those that are not on a side that is counted with the next tile.
std::int64_t own_vertices(const BaseMesh& mesh, int level, const PixelRect& rect, bool has_right,
                          bool has_below) {
    const auto scaled = [&](int pixels) { return std::ldexp(static_cast<float>(pixels), -level); };
    const float right = scaled(rect.width() - 1), bottom = scaled(rect.height() - 1);
    return std::ranges::count_if(mesh.position, [&](const Vec2f& place) {
        return !(has_right && place.x() == right) && !(has_below && place.y() == bottom);
    });
}

// A file of a list that is not there is like one that is broken: the other tiles can do without.
template <class Read>
auto reading(const Read& read) {
    try {
        return read();
    } catch (const Error& error) {
        throw Error(error.kind() == ErrorKind::kIo ? ErrorKind::kBadFile : error.kind(), error.what());
    }
}

bool has_none(const PixelPart& part) {
    return !part.mask.empty() && part.mask.count() == 0;
}

}  // namespace

TileWork::TileWork(const PlannedTileSet& planned, const BuildOptions& options, Context& context)
    : planned_(planned),
      options_(options),
      context_(context),
      folder_(options.output),
      key_(plan_key(planned.plan)) {}

TileWork::~TileWork() = default;

TilePixels& TileWork::pixels() {
    // A set that is complete but for a tile has no copy of its picture any more.
    if (!planned_.jobs.copy.empty()) spool(context_.progress);
    if (!pixels_) pixels_ = std::make_unique<TilePixels>(planned_.picture, options_.mask, planned_.read);
    return *pixels_;
}

bool TileWork::run(const TileJob& job, const Progress& progress) {
    switch (job.kind) {
        case TileJob::Kind::kSpool:
            return spool(progress);
        case TileJob::Kind::kSample:
            return sample(job.tile.row, progress);
        case TileJob::Kind::kThreshold:
            return find_threshold();
        case TileJob::Kind::kTile:
            return make(job.tile, progress);
        case TileJob::Kind::kIndex:
            index();
            return true;
    }
    return false;
}

bool TileWork::spool(const Progress& progress) {
    // It appears as a whole, so what is there is complete.
    if (std::filesystem::exists(planned_.picture)) return false;
    make_folder(in_set(folder_, kWorkFolder));
    progress(0, "copy");
    for (const std::string& warning : spool_picture(options_.input, planned_.picture, planned_.read)) {
        const std::string line = cat(options_.input, ": ", warning);
        if (std::ranges::count(context_.warnings, line) == 0) context_.warnings.push_back(line);
    }
    return true;
}

bool TileWork::sample(int row, const Progress& progress) {
    if (has_threshold(folder_, key_) || has_sample(folder_, row, key_)) return false;
    const TileGrid& grid = planned_.jobs.grid;
    const SimplifyParams params = tile_collapse(planned_.params, planned_.common);
    const std::vector<SampledPart> parts = sampled_parts(grid, row, planned_.common.density);
    // Without it nothing can be done, so errors that it makes are not those of a part.
    const TilePixels& source = pixels();
    RowSample sum;
    for (std::size_t n = 0; n < parts.size(); ++n) {
        progress(static_cast<double>(n) / static_cast<double>(parts.size()), "sample");
        try {
            PixelPart part = reading([&] { return source.read(parts[n].pixels, planned_.mask); });
            if (has_none(part)) continue;
            FeatureImage feature = tile_features(part.image, planned_.common, part.mask);
            sum.counts.add(sample_density(std::move(feature), std::move(part.mask), parts[n].margin, params,
                                          planned_.common.density));
        } catch (const Error& error) {
            // The tile says so when it is built.
            if (error.kind() != ErrorKind::kBadFile) throw;
            if (sum.unread.empty()) sum.unread = printable_line(error.what());
        }
    }
    write_sample(folder_, row, key_, sum);
    return true;
}

bool TileWork::find_threshold() {
    if (has_threshold(folder_, key_)) return false;
    const TileGrid& grid = planned_.jobs.grid;
    DensitySample sum;
    std::string unread;
    for (int row = 0; row < grid.rows(0); ++row) {
        const RowSample sample = read_sample(folder_, row, key_);
        sum.add(sample.counts);
        if (unread.empty()) unread = sample.unread;
    }
    if (sum.pixels == 0 && !unread.empty()) throw Error(ErrorKind::kBadFile, unread);
    write_threshold(folder_, key_,
                    in_file(options_.input, [&] { return threshold_for(sum, grid, planned_.vertices); }));
    return true;
}

TileCommon TileWork::common() const {
    TileCommon common = planned_.common;
    if (planned_.jobs.first_pass) common.max_increment = read_threshold(folder_, key_);
    return common;
}

// An index of an earlier run tells of other files, and coarser tiles were made without this one if it could
// not be made then.
void TileWork::forget_coarser(TileName tile) const {
    const TileGrid& grid = planned_.jobs.grid;
    remove(kIndexFile);
    while (tile.level + 1 < grid.levels()) {
        tile = grid.parent(tile);
        remove(tile_record(tile));
    }
}

void TileWork::remove(const std::string& path) const {
    std::error_code is_not_there;
    std::filesystem::remove(in_set(folder_, path), is_not_there);
}

bool TileWork::make(const TileName& tile, const Progress& progress) {
    progress(0, "check");
    if (is_finished(folder_, tile, key_)) {
        ++kept_;
        return false;
    }
    forget_coarser(tile);
    make_level_folders(folder_, tile.level);
    TileRecord record;
    record.tile = tile;
    record.key = key_;
    try {
        if (tile.level == 0)
            build(record, progress);
        else
            coarsen(record);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::kUnsupported || error.kind() == ErrorKind::kInternal)
            throw Error(error.kind(), cat(options_.input, ": tile ", tile_text(tile), ": ", error.what()));
        if (error.kind() != ErrorKind::kBadFile) throw;
        record = {};
        record.tile = tile;
        record.key = key_;
        record.missing = printable_line(error.what());
        // A run of all jobs tells of it at its end.
        if (!options_.tiles.job.empty())
            context_.warnings.push_back(cat("tile ", tile_text(tile), " is left out: ", error.what()));
    }
    if (record.files.empty())  // those of an earlier plan
        for (const std::string& file : {tile_container(tile), tile_view(tile)}) remove(file);
    write_record(folder_, record);
    if (const std::string text = density_warning(record, planned_); !text.empty() && !told_dense_) {
        context_.warnings.push_back(cat(options_.input, ": ", text));
        told_dense_ = true;  // most others are like it
    }
    ++made_;
    return true;
}

void TileWork::build(TileRecord& record, const Progress& progress) {
    const TileGrid& grid = planned_.jobs.grid;
    const TileName tile = record.tile;
    const TilePixels& source = pixels();
    TilePart part = reading([&] { return source.read_tile(grid, tile, planned_.mask); });
    if (part.mask.has_none()) return;
    check_density(part.image, planned_, context_.max_memory);
    const TileCommon shared = common();
    const TileSides sides = sides_of_tile(part.image, planned_.params, shared, part.mask);
    FeatureImage feature;
    BuildResult built = build_tile(std::move(part.image), planned_.params, sides, shared, progress,
                                   std::move(part.mask.mask), &feature);
    const Level& level = built.mesh_image.levels.front();
    const TileErrors errors = tile_errors(
        level, feature, part.mask.own,
        {tile.column > 0, tile.row > 0, tile.column + 1 < grid.columns(0), tile.row + 1 < grid.rows(0)});
    record.pixels = errors.pixels;
    record.map_squares = errors.squares;
    const double gouraud = built.report.levels.front().gouraud_rms;
    record.gouraud_squares = gouraud * gouraud * static_cast<double>(errors.pixels);
    record.seam_pixels = errors.seam_pixels;
    record.seam_squares = errors.seam_squares;
    write(record, std::move(built.mesh_image), tile_layers(options_));
}

void TileWork::write(TileRecord& record, MeshImage mesh_image, LayerLayout layers) const {
    const TileName& tile = record.tile;
    const TileGrid& grid = planned_.jobs.grid;
    mesh_image.generator = context_.generator;
    const BaseMesh& mesh = mesh_image.levels.front().mesh;
    record.vertices = static_cast<std::int64_t>(mesh.vertex_count());
    record.faces = static_cast<std::int64_t>(mesh.faces.size());
    const PixelRect rect = grid.rect(tile);
    record.own_vertices = own_vertices(mesh, tile.level, rect, tile.column + 1 < grid.columns(tile.level),
                                       tile.row + 1 < grid.rows(tile.level));
    ContainerOptions container;
    compress(container, options_.compression, DracoMode::kEdgebreaker);
    container.layers = layers;
    write_container(in_set(folder_, tile_container(tile)), mesh_image, container);
    write_tile_view(mesh, mesh_image.source, grid, tile, context_.generator,
                    in_set(folder_, tile_view(tile)));
    record.files = {file_facts(folder_, tile_container(tile)), file_facts(folder_, tile_view(tile))};
}

void TileWork::coarsen(TileRecord& record) {
    std::optional<MeshImage> image = read_coarse_tile(folder_, planned_.jobs.grid, record.tile,
                                                      tile_collapse(planned_.params, planned_.common));
    if (image) write(record, *std::move(image), LayerLayout::kCompact);
}

std::vector<std::string> TileWork::folders_of_set() const {
    std::vector<std::string> folders = {folder_};
    for (int level = 0; level < planned_.jobs.grid.levels(); ++level) {
        const TileName tile{level, 0, 0};
        for (const std::string& file : {tile_record(tile), tile_view(tile)})
            folders.push_back(std::filesystem::path(in_set(folder_, file)).parent_path().string());
    }
    return folders;
}

void TileWork::index() {
    TileSetIndex index;
    index.plan = planned_.plan;
    index.threshold = planned_.jobs.first_pass ? read_threshold(folder_, key_) : 0;
    const TileGrid& grid = planned_.jobs.grid;
    for (int level = 0; level < grid.levels(); ++level)
        for (const TileName& tile : grid.tiles(level)) {
            TileRecord record = read_record(folder_, tile);
            if (record.missing.empty())
                index.tiles.push_back(std::move(record));
            else
                index.missing.push_back({tile, std::move(record.missing)});
        }
    std::ranges::sort(index.tiles, comes_before, &TileRecord::tile);
    write_tileset(folder_, index);
    write_index(folder_, index);
    for (const std::string& folder : folders_of_set()) remove_unclaimed_temporaries(folder);
    std::error_code done_by_another;  // process that does the same job
    std::filesystem::remove_all(in_set(folder_, kWorkFolder), done_by_another);
}

}  // namespace imgmesh
