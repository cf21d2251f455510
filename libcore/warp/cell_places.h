// Where the pixels of a warped image come to lie in the output, as whole numbers. Internal to warp/.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/warp/displacement.h"

namespace imgmesh {

enum class Cover : std::uint8_t;

/// A row of places, from the rim left of the image to the rim right of it: width + 2.
struct PlaceRow {
    std::vector<std::int32_t> x, y;
};

/// The places of all pixels, and of a rim one pixel wide around the image that moves as the pixels beside
/// it do; rows and columns count from -1 there. `field` must live as long.
class CellPlaces {
  public:
    /// Places are multiples of 1/4096 output pixel: 16-bit samples of the steepest edge change by 16 codes in
    /// one. They are kept within 2^17 pixels of the origin, beyond any image, so that products of their
    /// differences fit 64 bits.
    static constexpr int kBits = 12;
    static constexpr int kOne = 1 << kBits;
    static constexpr double kFarthest = 131072;

    /// The output has width x height pixels; the centre of its pixel i is at (i + 0.5) / scale - 0.5.
    CellPlaces(const DisplacementField& field, int width, int height);

    int width() const { return field_.width; }
    int height() const { return field_.height; }
    void row(int y, PlaceRow& out) const;
    /// Whether a cell between the rows y and y + 1 may touch the output rows [first, last).
    bool reaches(int y, int first, int last) const;
    /// What the cell with the top left pixel (x, y) covers with: kNothing where it is not drawn, kSolid where
    /// its four pixels are, else kBoundary.
    Cover cover(int x, int y) const;

  private:
    struct Range {
        std::int32_t low, high;
    };
    const DisplacementField& field_;
    double scale_x_, scale_y_;
    std::vector<Range> rows_;  // of y of the places of row y at y + 1, the rim included
};

}  // namespace imgmesh
