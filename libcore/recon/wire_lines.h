// The lines of the wire drawing.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// The edges of a mesh as lines of one width, with round ends.
class WireLines {
  public:
    /// `points` are the vertices in a drawing of this size, `scale` times as large as its source [output
    /// pixels]. Throws Error(kUnsupported) if the edges cover more than 64 times the `pixels` of source and
    /// drawing.
    WireLines(const BaseMesh& mesh, std::vector<Vec2d> points, const Vec2d& size, double scale,
              double pixels);

    /// Writes what lines cover of each pixel of the rows [first, last), 0 to opacity: `ink` has rows of
    /// `width`. The rows begin at a multiple of kRows and are no more than kRows.
    void cover(int first, int last, int width, std::span<float> ink) const;

    static constexpr int kRows = 16;

  private:
    // Lines let a little of the image through. Lines that would cover more than a third of the image are
    // faded.
    static constexpr double kMostOpaque = 0.9, kMostInk = 0.3;

    double reach() const { return width_ / 2 + 0.5; }  // where a line's ramp of one pixel ends

    std::vector<Vec2d> points_;
    std::vector<std::vector<std::pair<Id, Id>>> edges_of_band_;  // those that reach into kRows rows
    double width_;                                               // [output pixels]
    double opacity_;
};

}  // namespace imgmesh
