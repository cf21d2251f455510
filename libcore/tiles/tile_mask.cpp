#include "libcore/tiles/tile_mask.h"

#include <algorithm>

namespace imgmesh {
namespace {

// Of the tile and the line of pixels around it.
class MaskAround {
  public:
    MaskAround(const Mask& picture, const TileGrid& grid, const TileName& tile)
        : picture_(picture), grid_(grid), tile_(tile), rect_(grid.rect(tile)), reach_(reach_of(grid, tile)) {}

    TileMask run() const {
        TileMask out;
        out.mask = Mask(GridSize{rect_.width(), rect_.height()}, 1);
        out.own = out.mask;
        out.cut = cut_sides();
        for (int y = rect_.top; y < rect_.bottom; ++y)
            for (int x = rect_.left; x < rect_.right; ++x) {
                const std::size_t i = out.mask.index(x - rect_.left, y - rect_.top);
                const bool on_line = is_shared(x, y);
                const bool meshed = inside(x, y) && (!on_line || has(tile_, x, y));
                out.mask.values[i] = meshed;
                out.own.values[i] = on_line ? meshed && !later_has(x, y) : meshed;
            }
        if (std::ranges::count(out.mask.values, 0) == 0) out.mask = {};
        return out;
    }

  private:
    bool inside(int x, int y) const { return picture_.at(x - reach_.left, y - reach_.top); }

    bool left_of(int x) const { return tile_.column > 0 && x == rect_.left; }
    bool right_of(int x) const { return tile_.column + 1 < grid_.columns(0) && x == rect_.right - 1; }
    bool top_of(int y) const { return tile_.row > 0 && y == rect_.top; }
    bool bottom_of(int y) const { return tile_.row + 1 < grid_.rows(0) && y == rect_.bottom - 1; }
    bool is_shared(int x, int y) const { return left_of(x) || right_of(x) || top_of(y) || bottom_of(y); }

    // Whether the pixel has a face in one of the four cells around it that lie from (first_x, first_y) to
    // (last_x, last_y).
    bool covered(int x, int y, int first_x, int first_y, int last_x, int last_y) const {
        if (!inside(x, y)) return false;
        for (int top = std::max(y - 1, first_y); top <= std::min(y, last_y); ++top)
            for (int left = std::max(x - 1, first_x); left <= std::min(x, last_x); ++left)
                if (inside(left, top) + inside(left + 1, top) + inside(left, top + 1) +
                        inside(left + 1, top + 1) >=
                    3)
                    return true;
        return false;
    }
    bool covered_somewhere(int x, int y) const { return covered(x, y, x - 1, y - 1, x, y); }
    bool covered_in(const TileName& tile, int x, int y) const {
        const PixelRect rect = grid_.rect(tile);
        return covered(x, y, rect.left, rect.top, rect.right - 2, rect.bottom - 2);
    }
    bool has(const TileName& tile, int x, int y) const {
        return covered_in(tile, x, y) || (inside(x, y) && !covered_somewhere(x, y));
    }

    bool later_has(int x, int y) const {
        for (int row = tile_.row; row <= tile_.row + bottom_of(y); ++row)
            for (int column = tile_.column - left_of(x); column <= tile_.column + right_of(x); ++column)
                if ((row > tile_.row || column > tile_.column) && has({0, column, row}, x, y)) return true;
        return false;
    }

    // A pixel beside the line that is outside splits the fan of one on it, which then must stay a vertex, or
    // leaves a part of the line without a face, where no pixel may be moved to.
    CutSides cut_sides() const {
        const auto all_inside = [&](int left, int top, int right, int bottom) {
            for (int y = std::max(top, reach_.top); y < std::min(bottom, reach_.bottom); ++y)
                for (int x = std::max(left, reach_.left); x < std::min(right, reach_.right); ++x)
                    if (!inside(x, y)) return false;
            return true;
        };
        const auto& [left, top, right, bottom] = rect_;
        return {!all_inside(left - 1, top, left + 2, bottom), !all_inside(left, top - 1, right, top + 2),
                !all_inside(right - 2, top, right + 1, bottom),
                !all_inside(left, bottom - 2, right, bottom + 1)};
    }

    const Mask& picture_;
    const TileGrid& grid_;
    const TileName tile_;
    const PixelRect rect_, reach_;
};

}  // namespace

PixelRect reach_of(const TileGrid& grid, const TileName& tile) {
    const PixelRect rect = grid.rect(tile);
    return {std::max(0, rect.left - 1), std::max(0, rect.top - 1), std::min(grid.width(), rect.right + 1),
            std::min(grid.height(), rect.bottom + 1)};
}

TileMask tile_mask(const Mask& picture, const TileGrid& grid, const TileName& tile) {
    if (picture.empty()) {
        const PixelRect rect = grid.rect(tile), own = grid.own_rect(tile);
        TileMask all;
        all.own = Mask(GridSize{rect.width(), rect.height()}, 1);
        for (int y = 0; y < rect.height(); ++y)
            for (int x = y < own.height() ? own.width() : 0; x < rect.width(); ++x)
                all.own.Grid::at(x, y) = 0;
        return all;
    }
    return MaskAround(picture, grid, tile).run();
}

}  // namespace imgmesh
