// How much the two halves of a disc differ: the evidence for a contour through its centre.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "libcore/segment/contours/codes.h"
#include "libcore/segment/contours/small_image.h"

namespace imgmesh {

/// The line between pixel (x, y) and its right neighbour, or its lower one.
struct Crack {
    int x = 0;
    int y = 0;
    bool down = false;
};

/// Compares halves of discs around cracks, after the gradients of Martin, Fowlkes and Malik (TPAMI 2004). A
/// disc is cut into 16 wedges, whose sums give its halves in eight directions.
class HalfDiscs {
  public:
    explicit HalfDiscs(const SmallImage& image);

    /// Returns the contrast across a crack between two pixels of the image, in [0, 1]: 0.45 times the
    /// colours' (1 - exp(-population_distance), mean over radii 3, 5 and 10), 0.35 times the textons' and 0.2
    /// times the palette's (chi-square distance of histograms, mean over radii 5, 10 and 20). Only pixels
    /// inside the mask count. The disc is cut across `normal`, the direction of steepest change [radians, of
    /// (x, y)]; its sign does not matter. Between two of the eight directions, the contrast is interpolated.
    float contrast(const Crack& crack, double normal) const;

  private:
    // A pixel of a disc: where it is relative to the crack's pixel, and where its wedge's histograms begin.
    struct Offset {
        std::ptrdiff_t pixel;
        std::size_t wedge, histograms;
    };
    // Pixels around a crack from the centre outwards; ring k ends before ring_end[k].
    struct Disc {
        std::vector<Offset> offsets;
        std::array<std::size_t, 4> ring_end{};
    };
    // 1, the colour and its squares; 0 outside the mask.
    using Sums = Eigen::Array<float, 8, 1>;
    // The texton and the colour, as bins of the two histograms.
    struct Bins {
        std::uint8_t texton, color;
    };

    Disc disc(bool down) const;

    // With a margin of pixels outside, so that every disc lies within.
    Grid<Sums> sums_;
    Grid<Bins> bins_;
    std::array<Disc, 2> discs_;  // around cracks to the right and down
};

}  // namespace imgmesh
