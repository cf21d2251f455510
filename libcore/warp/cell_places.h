// Where the pixels of a warped image lie in the output, as whole numbers. Internal to warp/.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/warp/displacement.h"

namespace imgmesh {

enum class Cover : std::uint8_t;

/// A row of width + 2 places, from the rim left of the image to the rim right of it.
struct PlaceRow {
    std::vector<std::int32_t> x, y;
};

/// The places of all pixels and of a rim one pixel wide around the image. The rim moves as the pixels beside
/// it do; its rows and columns are numbered from -1. `field` must outlive this object.
class CellPlaces {
  public:
    /// Places are multiples of 1/4096 output pixel. One such step changes a 16-bit sample by 16 codes at the
    /// steepest edge. Places are kept within 2^17 pixels of the origin, beyond any image, so products of
    /// their differences fit 64 bits.
    static constexpr int kBits = 12;
    static constexpr int kOne = 1 << kBits;
    static constexpr double kFarthest = 131072;

    /// The output has width x height pixels; the centre of its pixel i is at (i + 0.5) / scale - 0.5.
    CellPlaces(const DisplacementField& field, int width, int height);

    int width() const { return field_.width; }
    int height() const { return field_.height; }
    void row(int y, PlaceRow& out) const;
    /// Returns whether a cell between the rows y and y + 1 may touch the output rows [first, last).
    bool reaches(int y, int first, int last) const;
    /// Returns how the cell with the top left pixel (x, y) is drawn: kNothing if it is not drawn, kSolid if
    /// its four pixels are drawn, else kBoundary.
    Cover cover(int x, int y) const;

  private:
    struct Range {
        std::int32_t low, high;
    };
    const DisplacementField& field_;
    double scale_x_, scale_y_;
    std::vector<Range> rows_;  // range of y over the places of row y, at index y + 1; the rim is included
};

}  // namespace imgmesh
