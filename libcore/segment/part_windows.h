// Parts of a picture with the pixels around them.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "libcore/segment/segment_parts.h"

namespace imgmesh {

/// A rectangle of the picture that holds a part's own pixels.
struct PartWindow {
    PixelRect rect;
    PixelRect own;  ///< in the window
    FeatureImage luv;
    Grid<Id> cells;  ///< of the part; `outside` in the margin, kNone outside the mask
};

/// Reads parts row by row, with margins. Holds the margins of a row of parts and of those above and below,
/// and reads each part a second time for them.
class PartWindows {
  public:
    /// margin  how many pixels of the neighbours a window has, as far as the picture goes
    PartWindows(const PictureParts& picture, int margin) : picture_(picture), margin_(margin) {}

    /// To be called for all parts, row by row. `cells` are those of the part.
    PartWindow window(int column, int row, const PicturePart& part, const Grid<Id>& cells, Id outside);

  private:
    // A piece of a part.
    struct Piece {
        PixelRect rect;  // in the picture
        FeatureImage luv;
        Grid<std::uint8_t> inside;
    };

    void begin_row(int row);
    Piece piece_of(const PicturePart& part, const PixelRect& own, const PixelRect& rect) const;
    std::vector<Piece> margins_of(int column, int row) const;

    const PictureParts& picture_;
    int margin_;
    int row_ = -1;
    std::map<std::pair<int, int>, std::vector<Piece>> margins_;  // by row and column
};

}  // namespace imgmesh
