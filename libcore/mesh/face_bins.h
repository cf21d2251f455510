// The faces of a mesh by places: which of them holds a point.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/base/grid.h"
#include "libcore/mesh/exact_face.h"

namespace imgmesh {

/// Finds the face that holds a point. The image is cut into about half as many bins as there are faces; each
/// lists the faces that reach into it, and the outermost ones those beyond the image too.
class FaceBins {
  public:
    /// Throws Error(kUnsupported) for a mesh off the grid (exact_faces()), and for one whose faces are in so
    /// many bins as no sound mesh's are: they lie over one another, or all are splinters.
    FaceBins(const BaseMesh& mesh, const GridSize& image);

    const ExactFace& face(Id id) const { return faces_[id]; }

    /// Returns the face that holds p. Of several the one of least `order`, then of lowest id, but any face
    /// with p strictly inside, which a mesh without overlaps has only alone. kNone if there is none.
    /// Adds the number of faces that it has tried to `tries`.
    Id find(GridPoint p, std::int64_t& tries) const;

  private:
    int column_of(int x) const { return clamped(x, shift_x_, columns_); }
    int row_of(int y) const { return clamped(y, shift_y_, rows_); }
    static int clamped(int unit, int shift, int count) {
        const int bin = (unit + kPixelUnits / 2) >> shift;
        return bin < 0 ? 0 : bin < count ? bin : count - 1;
    }
    void choose_size(const GridSize& image);
    void fill(const BaseMesh& mesh);

    std::vector<ExactFace> faces_;
    int shift_x_ = 0, shift_y_ = 0;  // the side of a bin is 2^shift units
    int columns_ = 0, rows_ = 0;
    std::vector<std::uint32_t> begin_;  // of each bin in listed_, and the end of the last
    std::vector<Id> listed_;            // in each bin in ascending order
};

}  // namespace imgmesh
