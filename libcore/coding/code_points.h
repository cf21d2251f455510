// The vertices of a coded mesh, as counts of vertices in cells that halve until each is one point of the
// grid. All cells of one size are divided before any smaller one, in raster order, so a cell knows its
// neighbours.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/coding/bit_model.h"
#include "libcore/coding/coded_mesh.h"

namespace imgmesh::coding {

/// What is known beside a cell that is divided into two halves: counts of vertices, twice as much where a
/// neighbour is half as large.
struct AroundHalves {
    std::uint32_t room_first = 0, room_second = 0;      ///< points of the grid in each half
    std::uint32_t before = 0, after = 0;                ///< beyond the first half and beyond the second one
    std::uint32_t beside_first = 0, beside_second = 0;  ///< beside each half, where that is divided already
    std::uint32_t beside = 0;                           ///< on the other side of both
    std::uint32_t corner_before = 0, corner_after = 0;  ///< at the corners
    std::uint32_t level = 0;                            ///< the size of the cell is 2^level
    std::uint32_t down = 0;                             ///< 1 if the halves are side by side
};

/// Codes how many vertices of a cell are in its first half.
class HalvesModel {
  public:
    HalvesModel();

    /// count  vertices of the cell, at least 1; first: those of the first half, which a decoder ignores
    template <class Coder>
    std::uint32_t code(Coder& coder, std::uint32_t first, std::uint32_t count, const AroundHalves& around) {
        const std::uint32_t room = around.room_first + around.room_second;
        if (around.room_first == 0) return 0;
        if (around.room_second == 0) return count;
        if (count >= room) return around.room_first;
        const std::uint32_t half = count / 2;
        const bool even = count % 2 == 0;
        if (even && tie_.code(coder, first == half, tie_contexts(count, around), tie_odds(count, around)))
            return half;
        const bool to_first =
            side_.code(coder, 2 * first > count, side_contexts(count, around), side_odds(around));
        const std::uint32_t larger = to_first ? first : count - first, least = half + 1;
        std::uint32_t more = 0;
        while (least + more < count &&
               excess_.code(coder, larger > least + more, excess_contexts(count, more, around)))
            ++more;
        // A damaged stream may ask for more than there is room for.
        const std::uint32_t taken = to_first ? least + more : count - least - more;
        const std::uint32_t fewest = count > around.room_second ? count - around.room_second : 0;
        return std::clamp(taken, fewest, std::min(count, around.room_first));
    }

  private:
    static BitModel<5>::Contexts side_contexts(std::uint32_t count, const AroundHalves& around);
    static BitModel<3>::Contexts tie_contexts(std::uint32_t count, const AroundHalves& around);
    static BitModel<3>::Contexts excess_contexts(std::uint32_t count, std::uint32_t more,
                                                 const AroundHalves& around);
    // What is expected before anything has been seen, fitted to twelve photographs.
    static int side_odds(const AroundHalves& around);
    static int tie_odds(std::uint32_t count, const AroundHalves& around);

    BitModel<5> side_;
    BitModel<3> tie_, excess_;
};

/// A level: counts of the cells, with a ring of empty ones around them.
class CountGrid {
  public:
    CountGrid(int width, int height)
        : width_(width),
          height_(height),
          counts_(static_cast<std::size_t>(width + 4) * static_cast<std::size_t>(height + 4)) {}

    int width() const { return width_; }
    int height() const { return height_; }
    /// x and y from -2 to 1 beyond the last.
    std::uint32_t& at(int x, int y) { return counts_[index(x, y)]; }
    std::uint32_t at(int x, int y) const { return counts_[index(x, y)]; }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y + 2) * static_cast<std::size_t>(width_ + 4) +
               static_cast<std::size_t>(x + 2);
    }
    int width_, height_;
    std::vector<std::uint32_t> counts_;
};

/// Codes distinct points of a grid of columns x rows. points: any order; a decoder ignores all but their
/// number `count`, which is at most columns * rows. Returns them in raster order.
template <class Coder>
std::vector<GridPoint> code_points(Coder& coder, HalvesModel& model, int columns, int rows,
                                   std::uint32_t count, const std::vector<GridPoint>& points);

}  // namespace imgmesh::coding

#include "libcore/coding/code_points.inl"
