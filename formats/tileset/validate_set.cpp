#include "formats/tileset/validate_set.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>

#include "formats/container/container.h"
#include "formats/container/validate.h"
#include "formats/files/atomic_file.h"
#include "formats/tileset/set_findings.h"
#include "formats/tileset/tile_set_files.h"
#include "formats/tileset/tile_side.h"
#include "formats/tileset/tileset_json.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

// Of a container's JSON and index there is more to read than of tileset.json.
constexpr std::uint64_t kMostTilesetBytes = std::uint64_t{64} << 20;

const Finding& set_finding(std::string_view code) {
    return *std::ranges::find(kSetFindings, code, &Finding::code);
}

class SetValidator {
  public:
    SetValidator(const std::string& folder, const ContainerLimits& limits, const Progress& progress)
        : folder_(folder), limits_(limits), progress_(progress) {}

    std::vector<Issue> run() {
        try {
            index_ = read_index(folder_);
        } catch (const Error& error) {
            add(error.kind() == ErrorKind::kUnsupported ? "set.version" : "set.index", error.what());
            return std::move(issues_);
        }
        for (const MissingTile& tile : index_.missing)
            add("set.missing", cat(tile_text(tile.tile), ": ", tile.reason));
        check_tileset();
        has_mask_ = level_totals(index_, 0).pixels != std::int64_t{index_.plan.width} * index_.plan.height;
        const TileGrid grid = index_.plan.grid();
        for (const TileRecord& record : index_.tiles) {
            start_row(record.tile, grid);
            check_tile(record, grid);
            progress_(static_cast<double>(++done_) / static_cast<double>(index_.tiles.size()), "validate");
        }
        return std::move(issues_);
    }

  private:
    void add(std::string_view code, const std::string& text) {
        issues_.push_back({&set_finding(code), text, {}, 1});
    }

    void check_tileset() {
        for (const TextFile& expected : tileset_files(index_)) {
            const std::string path = in_set(folder_, expected.path);
            try {
                const std::vector<std::uint8_t> bytes =
                    read_file(path, kMostTilesetBytes, FileKind::kRegular);
                if (!std::ranges::equal(bytes, expected.text, {}, {},
                                        [](char c) { return static_cast<std::uint8_t>(c); }))
                    add("set.tileset", cat(expected.path, ": is not what the index gives"));
            } catch (const Error& error) {
                add("set.tileset", cat(expected.path, ": ", error.what()));
            }
        }
    }

    // Sides of tiles above are kept for the row below them.
    void start_row(const TileName& tile, const TileGrid& grid) {
        if (row_ && row_->level == tile.level && row_->row == tile.row) return;
        const bool next = row_ && row_->level == tile.level && row_->row + 1 == tile.row;
        above_ = next ? std::move(below_) : std::vector<std::optional<TileSide>>();
        above_.resize(static_cast<std::size_t>(grid.columns(tile.level)));
        below_.assign(above_.size(), std::nullopt);
        left_.reset();
        row_ = tile;
    }

    // What a record and the index tell of a tile is the same.
    void check_record(const TileRecord& record) {
        try {
            const TileRecord other = read_record(folder_, record.tile);
            if (other.key != record.key || !other.missing.empty() || other.files != record.files)
                add("set.record", cat(tile_record(record.tile), ": is not that of the index"));
        } catch (const Error& error) {
            add("set.record", cat(tile_record(record.tile), ": ", error.what()));
        }
    }

    void check_tile(const TileRecord& record, const TileGrid& grid) {
        std::optional<TileSide> left;
        std::swap(left, left_);
        if (left_of_ != record.tile.column - 1) left.reset();
        check_record(record);
        bool whole = !record.files.empty();
        for (const TileFile& file : record.files)
            if (!has_content(folder_, file)) {
                add("set.file", cat(file.path, ": is not there, or has other bytes than the index tells"));
                whole = whole && file.path != record.files[0].path;
            }
        if (!whole || !check_container(record, grid)) return;
        check_sides(record.tile, grid, left);
    }

    // Returns whether it has been read.
    bool check_container(const TileRecord& record, const TileGrid& grid) {
        const std::string& path = record.files[0].path;
        const TileName& tile = record.tile;
        const bool outer = tile.level > 0 && (tile.column + 1 == grid.columns(tile.level) ||
                                              tile.row + 1 == grid.rows(tile.level));
        bool sound = true;
        for (Issue& issue : validate_container(in_set(folder_, path), limits_)) {
            const std::string_view code = issue.finding->code;
            if (outer && (code == "mesh.outside" || code == "mesh.area")) continue;
            sound = sound && issue.finding->severity != Severity::kError;
            issue.text = cat(path, ": ", issue.text);
            issues_.push_back(std::move(issue));
        }
        if (!sound) return false;
        image_ = read_container(in_set(folder_, path), limits_).mesh_image;
        const GridSize size = level_size(grid, tile);
        const BaseMesh& mesh = image_.levels[0].mesh;
        if (static_cast<const GridSize&>(image_.source) != size) {
            add("set.size", cat(path, ": is of ", image_.source.width, "x", image_.source.height,
                                " pixels, expected ", size.width, "x", size.height));
            return false;
        }
        if (static_cast<std::int64_t>(mesh.vertex_count()) != record.vertices ||
            static_cast<std::int64_t>(mesh.faces.size()) != record.faces)
            add("set.counts", cat(path, ": has ", mesh.vertex_count(), " vertices and ", mesh.faces.size(),
                                  " faces, expected ", record.vertices, " and ", record.faces));
        return true;
    }

    void check_sides(const TileName& tile, const TileGrid& grid, const std::optional<TileSide>& left) {
        const auto column = static_cast<std::size_t>(tile.column);
        if (left) compare({tile.level, tile.column - 1, tile.row}, *left, tile, SideOf::kLeft);
        if (above_[column])
            compare({tile.level, tile.column, tile.row - 1}, *above_[column], tile, SideOf::kTop);
        above_[column].reset();
        left_of_ = tile.column;
        if (tile.column + 1 < grid.columns(tile.level)) left_ = tile_side(image_, SideOf::kRight);
        if (tile.row + 1 < grid.rows(tile.level)) below_[column] = tile_side(image_, SideOf::kBottom);
    }

    void compare(const TileName& other, const TileSide& of_other, const TileName& tile, SideOf side) {
        const TileSide own = tile_side(image_, side);
        const std::string both =
            cat(tile_container(other), " and ", tile_container(tile), ": on their side ");
        const std::string vertices = vertex_difference(of_other, own),
                          pixels = pixel_difference(of_other, own);
        // Of an outline a coarser tile may have less than its neighbour.
        const bool may_differ = tile.level > 0 && has_mask_;
        if (!vertices.empty()) add(may_differ ? "set.mask" : "set.side", both + vertices);
        if (!pixels.empty()) add(may_differ ? "set.mask" : "set.pixels", both + pixels);
    }

    const std::string& folder_;
    const ContainerLimits& limits_;
    const Progress& progress_;
    TileSetIndex index_;
    std::vector<Issue> issues_;
    std::size_t done_ = 0;
    bool has_mask_ = false;  // of the whole picture, or missing tiles
    MeshImage image_;        // of the tile that is checked
    std::optional<TileName> row_;
    std::vector<std::optional<TileSide>> above_, below_;
    std::optional<TileSide> left_;  // the right side of the tile in column left_of_
    int left_of_ = -1;
};

}  // namespace

std::vector<Issue> validate_tile_set(const std::string& folder, const ContainerLimits& limits,
                                     const Progress& progress) {
    const Progress told = progress ? progress : [](double, std::string_view) {};
    return SetValidator(folder, limits, told).run();
}

}  // namespace imgmesh
