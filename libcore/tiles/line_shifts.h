// Where the pixels of a line lie on its vertices: the pixel map in one dimension.
#pragma once

#include <span>
#include <vector>

namespace imgmesh {

/// A pixel of a side lies less than a pixel from its own place, so that the corners of a tile cannot fold.
inline constexpr int kShiftSteps = 8;               ///< of the grid of places in a pixel
inline constexpr int kMostShift = kShiftSteps - 1;  ///< [1 / kShiftSteps px]

/// Returns how far each pixel of a line is shifted along it to where the polyline has its colour
/// [1 / kShiftSteps px]. It is the best of all such maps: the sum over pixels of |c(P) - c|^2 plus
/// `smoothness` times the squared difference of the shifts of neighbours is least (Viterbi 1967). Pixels keep
/// their order, at least one step apart, and those at the ends rest.
///
/// line      pixels, `channels` features each, interleaved
/// vertices  pixels that are vertices, ascending, the first and the last pixel among them
/// colors    of the vertices, interleaved
/// Takes O(n) time with a factor of (2 kMostShift + 1)^2. The bits are the same on every machine.
std::vector<int> line_shifts(std::span<const float> line, int channels, std::span<const int> vertices,
                             std::span<const float> colors, double smoothness);

}  // namespace imgmesh
