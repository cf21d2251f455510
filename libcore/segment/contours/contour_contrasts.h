// The contrast along the outlines of regions, with their directions known.
#pragma once

#include <array>
#include <vector>

#include "libcore/segment/contours/half_discs.h"
#include "libcore/segment/labels.h"
#include "libcore/segment/region_graph.h"

namespace imgmesh {

/// Returns the contrast of every pair of neighbours in different regions, in [0, 1]: HalfDiscs::contrast()
/// across the outline's direction there, which is that of the pairs of the same two regions within 4 pixels.
/// Larger images are measured at a smaller size (SmallImage), where several pairs share a contrast. The image
/// is L*u*v*, of the regions' size. The result is the same for any number of threads. Takes O(pixels) time
/// plus some microseconds for each pair at the smaller size.
PairContrasts contour_contrasts(const FeatureImage& image, const LabelImage& regions);

/// The same of an image that is given in parts: first all of them through add(), then measure(), then
/// contrasts() of each.
///
/// A part is a window of the image, whose first pixel is (left, top) of it, with the region of each pixel,
/// numbered alike in all parts. Of its pairs those count whose first pixel, the left or the upper one, is in
/// `own`, a rectangle of the window. Each pixel of the image is in the `own` of one part.
class ContourPlaces {
  public:
    /// factor  that of the small image
    ContourPlaces(const GridSize& image, int factor);

    /// Returns how far the window must go beyond `own` on each side, as far as the image goes [pixels].
    int margin() const;

    void add(const Grid<Id>& window, int left, int top, const PixelRect& own);
    void measure(const SmallImage& small);
    /// Pairs that do not count have none. The window needs to go one pixel beyond `own` to the right and
    /// down.
    PairContrasts contrasts(const Grid<Id>& window, int left, int top, const PixelRect& own) const;

  private:
    // Pairs of neighbours in different regions that lie on one crack of the small image.
    struct Place {
        Crack crack;        // of the small image
        Crack pair;         // the first of the image's own pairs there
        double normal = 0;  // there
    };

    // The small image's crack nearest to that of a pair.
    Crack small_crack(const Crack& pair) const;

    GridSize image_;
    int factor_;
    GridSize small_;
    std::array<Grid<Id>, 2> place_of_;  // of cracks to the right and down
    std::vector<Place> places_;
    std::vector<float> measured_;  // of each place
};

}  // namespace imgmesh
