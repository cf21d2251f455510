// The image at the size at which contours are measured.
#pragma once

#include <array>
#include <cstdint>

#include "libcore/image/image.h"

namespace imgmesh {

/// Discs and filters have one size in pixels, which suits an image of this many pixels (481 x 321, those of
/// BSDS500). What people call a contour grows with the image, so larger ones are made smaller first.
inline constexpr double kMeasuredPixels = 481.0 * 321.0;

/// An image made smaller by a whole factor: each pixel is the mean of factor x factor pixels, as far as they
/// are inside the mask.
struct SmallImage {
    FeatureImage luv;           ///< L*u*v*; pixels outside the mask have the colour of a near pixel inside
    Grid<std::uint8_t> inside;  ///< 1 if some pixel is inside the mask
    int factor = 1;
};

/// Returns the factor for an image of that size: the nearest to sqrt(pixels / kMeasuredPixels), at least 1.
int measuring_factor(const GridSize& size);

/// The same for discs: an image of few rows or columns would have none left to compare.
int disc_factor(const GridSize& size);

/// Makes an image smaller that is given in parts.
class SmallImageSums {
  public:
    SmallImageSums(const GridSize& image, int factor);

    /// Adds the pixels of a part whose first pixel is (left, top) of the image. `regions` is kNone outside
    /// the mask and has the part's size. Takes O(pixels) time. Sums depend on the order of parts by their
    /// rounding alone.
    void add(const FeatureImage& part, const Grid<Id>& regions, int left, int top);

    /// After the last part; at least one pixel is inside the mask.
    SmallImage finish() const;

  private:
    struct Pixel {
        std::array<double, 3> sum{};
        std::int32_t count = 0;
    };
    int factor_;
    Grid<Pixel> pixels_;
};

/// The same of an image in one part.
SmallImage small_image(const FeatureImage& image, const Grid<Id>& regions, int factor);

}  // namespace imgmesh
