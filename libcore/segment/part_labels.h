// Labels of a picture that is given in parts: stored as runs, read as windows.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/base/grid.h"
#include "libcore/image/image.h"

namespace imgmesh {

/// How a picture is cut into parts, by lines from side to side.
struct PartGrid {
    std::vector<int> x;  ///< the first pixel of each column of parts, and the picture's width
    std::vector<int> y;  ///< the first pixel of each row of parts, and the picture's height

    int columns() const { return as_int(x.size()) - 1; }
    int rows() const { return as_int(y.size()) - 1; }
    GridSize size() const { return {x.back(), y.back()}; }
    PixelRect rect(int column, int row) const {
        return {x[as_index(column)], y[as_index(row)], x[as_index(column) + 1], y[as_index(row) + 1]};
    }
    /// Returns a part's rectangle with `margin` more pixels on each side, as far as the picture goes.
    PixelRect window(int column, int row, int margin) const;
    /// Returns the parts that have pixels of a rectangle: columns left .. right - 1, rows top .. bottom - 1.
    PixelRect parts_at(const PixelRect& rect) const;
};

/// One label a pixel, kNone where there is none. Takes 8 bytes for each run of equal labels in a row of a
/// part.
class PartLabels {
  public:
    /// Begins without labels.
    explicit PartLabels(PartGrid grid);

    const PartGrid& grid() const { return grid_; }
    void set(int column, int row, const Grid<Id>& labels);
    /// Turns each label into numbers[label].
    void renumber(const std::vector<Id>& numbers);
    /// Returns a rectangle of the picture.
    Grid<Id> window(const PixelRect& rect) const;

    /// Return the pixels of each of `count` labels, and the number of parts that it is in.
    std::vector<std::int64_t> count_pixels(std::size_t count) const;
    std::vector<std::int64_t> count_parts(std::size_t count) const;

  private:
    struct Run {
        Id label;
        int end;  // the column of the part that follows it
    };
    struct Part {
        std::vector<Run> runs;           // row by row
        std::vector<std::size_t> begin;  // of each row in `runs`, and their number; empty without labels
    };
    std::size_t index(int column, int row) const {
        return as_index(row) * as_index(grid_.columns()) + as_index(column);
    }

    PartGrid grid_;
    std::vector<Part> parts_;  // row by row
};

}  // namespace imgmesh
