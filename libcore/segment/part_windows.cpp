#include "libcore/segment/part_windows.h"

#include <algorithm>

namespace imgmesh {
namespace {

PixelRect common(const PixelRect& a, const PixelRect& b) {
    return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right),
            std::min(a.bottom, b.bottom)};
}

}  // namespace

PartWindows::Piece PartWindows::piece_of(const PicturePart& part, const PixelRect& own,
                                         const PixelRect& rect) const {
    const GridSize size{rect.width(), rect.height()};
    Piece piece{rect, FeatureImage(size.width, size.height, 3, std::vector<float>(size.pixel_count() * 3)),
                Grid<std::uint8_t>(size)};
    if (part.map.empty()) return piece;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const std::size_t i = part.map.index(rect.left - own.left + x, rect.top - own.top + y);
            piece.inside.at(x, y) = part.map[i].face != kNone;
            std::copy_n(part.luv.pixel(i), 3, piece.luv.pixel(x, y));
        }
    return piece;
}

std::vector<PartWindows::Piece> PartWindows::margins_of(int column, int row) const {
    const PixelRect own = picture_.grid.rect(column, row);
    const PicturePart part = picture_.read(column, row);
    if (own.width() <= 2 * margin_ || own.height() <= 2 * margin_) return {piece_of(part, own, own)};
    std::vector<Piece> pieces;
    for (const PixelRect& rect :
         {PixelRect{own.left, own.top, own.right, own.top + margin_},
          PixelRect{own.left, own.bottom - margin_, own.right, own.bottom},
          PixelRect{own.left, own.top + margin_, own.left + margin_, own.bottom - margin_},
          PixelRect{own.right - margin_, own.top + margin_, own.right, own.bottom - margin_}})
        pieces.push_back(piece_of(part, own, rect));
    return pieces;
}

void PartWindows::begin_row(int row) {
    row_ = row;
    if (margin_ == 0) return;
    const PixelRect rows = picture_.grid.parts_at(picture_.grid.window(0, row, margin_));
    std::erase_if(margins_, [&](const auto& item) { return item.first.first < rows.top; });
    if (picture_.grid.columns() == 1 && picture_.grid.rows() == 1) return;
    for (int r = rows.top; r < rows.bottom; ++r)
        for (int c = 0; c < picture_.grid.columns(); ++c)
            if (!margins_.contains({r, c})) margins_[{r, c}] = margins_of(c, r);
}

PartWindow PartWindows::window(int column, int row, const PicturePart& part, const Grid<Id>& cells,
                               Id outside) {
    if (row != row_) begin_row(row);
    PartWindow window;
    const PixelRect rect = window.rect = picture_.grid.window(column, row, margin_);
    const PixelRect own = picture_.grid.rect(column, row);
    window.own = {own.left - rect.left, own.top - rect.top, own.right - rect.left, own.bottom - rect.top};
    const GridSize size{rect.width(), rect.height()};
    window.luv = FeatureImage(size.width, size.height, 3, std::vector<float>(size.pixel_count() * 3));
    window.cells = Grid<Id>(size, kNone);
    for (int y = 0; y < own.height(); ++y) {
        std::ranges::copy(part.luv.row(y), window.luv.pixel(window.own.left, window.own.top + y));
        std::ranges::copy(cells.row(y), &window.cells.at(window.own.left, window.own.top + y));
    }
    const PixelRect near = picture_.grid.parts_at(rect);
    for (int r = near.top; r < near.bottom; ++r)
        for (int c = near.left; c < near.right; ++c) {
            if (c == column && r == row) continue;
            for (const Piece& piece : margins_.at({r, c})) {
                const PixelRect both = common(piece.rect, rect);
                for (int y = both.top; y < both.bottom; ++y)
                    for (int x = both.left; x < both.right; ++x) {
                        if (!piece.inside.at(x - piece.rect.left, y - piece.rect.top)) continue;
                        const float* const luv = piece.luv.pixel(x - piece.rect.left, y - piece.rect.top);
                        std::copy_n(luv, 3, window.luv.pixel(x - rect.left, y - rect.top));
                        window.cells.at(x - rect.left, y - rect.top) = outside;
                    }
            }
        }
    return window;
}

}  // namespace imgmesh
