// Source: OGC 22-025r4, 3D Tiles Specification 1.1.
#include "formats/tileset/tileset_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/files/atomic_file.h"
#include "formats/tileset/tile_view.h"

namespace imgmesh {
namespace {

using json = nlohmann::ordered_json;

// So many levels are in one file, of at most 1 + 4 + 16 + 64 tiles and references to 256 more.
constexpr int kLevelsOfFile = 4;

class Writer {
  public:
    explicit Writer(const TileSetIndex& index)
        : index_(index), grid_(index.plan.grid()), spacing_(mean_spacing(index)) {}

    std::vector<TextFile> files() {
        const TileName top{grid_.levels() - 1, 0, 0};
        json root = tile_member(top, "");
        // Viewers turn the content of tiles from glTF's y up to z up; this turns it back.
        root["transform"] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
        root["refine"] = "REPLACE";
        json document = head(error(top.level + 1), std::move(root));
        document["extras"] = {{"width", grid_.width()},
                              {"height", grid_.height()},
                              {"tile", grid_.step()},
                              {"levels", grid_.levels()},
                              {"spacing", spacing_}};
        files_.insert(files_.begin(), {kTilesetFile, document.dump() + '\n'});
        return std::move(files_);
    }

  private:
    double error(int level) const { return std::ldexp(spacing_, level); }

    json head(double geometric_error, json root) const {
        return {{"asset", {{"version", "1.1"}, {"tilesetVersion", plan_key(index_.plan)}}},
                {"geometricError", geometric_error},
                {"root", std::move(root)}};
    }

    // The tile and all below it, as members of a file in the folder that `up` leads out of.
    json tile_member(const TileName& tile, const std::string& up) {
        json member = {{"boundingVolume", {{"box", box(tile)}}},
                       {"geometricError", tile.level == 0 ? 0 : error(tile.level)}};
        const TileRecord* const record = find_tile(index_, tile);
        const std::string view = tile_view(tile);
        if (record && std::ranges::any_of(record->files, [&](const auto& f) { return f.path == view; }))
            member["content"] = {{"uri", up + view}};
        json children = json::array();
        if (tile.level > 0)
            for (const TileName& child : grid_.children(tile)) {
                children.push_back(begins_file(child) ? reference(child, up) : tile_member(child, up));
                children.back()["transform"] = place(child, tile);
            }
        if (!children.empty()) member["children"] = std::move(children);
        return member;
    }

    // A set of few levels is one file.
    bool begins_file(const TileName& tile) const {
        return grid_.levels() > kLevelsOfFile + 1 && (tile.level + 1) % kLevelsOfFile == 0;
    }

    // A tile of another file, which this adds.
    json reference(const TileName& tile, const std::string& up) {
        const std::string path = "view/" + tile_text(tile) + ".json";
        files_.push_back({path, head(error(tile.level + 1), tile_member(tile, "../../")).dump() + '\n'});
        // With its parent's error it is never shown in the place of what it refers to.
        return {{"boundingVolume", {{"box", box(tile)}}},
                {"geometricError", error(tile.level + 1)},
                {"content", {{"uri", up + path}}}};
    }

    // Where a tile lies in the frame of its parent, whose z is up.
    json place(const TileName& tile, const TileName& parent) const {
        const PixelRect own = grid_.rect(tile), other = grid_.rect(parent);
        return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, own.left - other.left, 0, other.top - own.top, 1};
    }

    // Around the mesh and the skirts, and as thick on both sides as the skirts are deep.
    json box(const TileName& tile) const {
        const PixelRect rect = grid_.rect(tile);
        const SkirtReach reach = skirt_reach(grid_, tile);
        const double unit = std::ldexp(1.0, tile.level);
        // A side of one pixel counts as a strip.
        const auto range = [&](int pixels, double before, double after) {
            const double strip = pixels == 1 ? 0.5 : 0;
            const double low = -strip - unit * before, high = pixels - 1 + strip + unit * after;
            return std::pair((low + high) / 2, (high - low) / 2);
        };
        const auto [x, half_x] = range(rect.width(), reach.left, reach.right);
        const auto [y, half_y] = range(rect.height(), reach.top, reach.bottom);
        return {x, 0, -y, half_x, 0, 0, 0, unit * kSkirtDepth, 0, 0, 0, half_y};
    }

    const TileSetIndex& index_;
    TileGrid grid_;
    double spacing_;
    std::vector<TextFile> files_;
};

}  // namespace

double mean_spacing(const TileSetIndex& index) {
    const TileTotals totals = level_totals(index, 0);
    if (totals.own_vertices == 0 || totals.pixels == 0) return 1;
    return std::sqrt(static_cast<double>(totals.pixels) / static_cast<double>(totals.own_vertices));
}

std::vector<TextFile> tileset_files(const TileSetIndex& index) {
    return Writer(index).files();
}

void write_tileset(const std::string& folder, const TileSetIndex& index) {
    for (const TextFile& text : tileset_files(index)) {
        AtomicFile file(in_set(folder, text.path), /*overwrite=*/true);
        file.write({reinterpret_cast<const std::uint8_t*>(text.text.data()), text.text.size()});
        file.commit();
    }
}

}  // namespace imgmesh
