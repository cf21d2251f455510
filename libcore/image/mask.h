// The pixels of an image that belong to it: masked images of any shape and topology.
#pragma once

#include <cstdint>

#include "libcore/image/image.h"

namespace imgmesh {

/// One flag for each pixel; not 0 inside. A mask without pixels (the default) masks nothing.
struct Mask : Grid<std::uint8_t> {
    using Grid::Grid;

    bool contains(std::size_t pixel) const { return empty() || values[pixel] != 0; }
    /// Returns whether pixel (x, y) is inside; false beyond the image. Only for a mask that is not empty().
    bool at(int x, int y) const { return GridSize::contains(x, y) && values[index(x, y)] != 0; }
    std::int64_t count() const;  ///< pixels inside
};

/// Returns the pixels with alpha >= `threshold`; empty() without a channel A or if all are inside.
Mask alpha_mask(const Image& image, float threshold);

/// The least alpha that 8 bits do not round to 0.
inline constexpr float kVisibleAlpha = 0.5f / 255;

/// Returns the least alpha of pixels that are worth a place in a mesh: kVisibleAlpha, but 7.5/255 where the
/// pixels between these make the outline of what is visible more than half as long again. Filters with
/// negative lobes leave such specks of 1 to 7 codes around every edge. A mesh needs vertices along all of
/// that outline, and what is seen would get few of them.
float least_visible_alpha(const Image& image);

/// Whether alpha is more than a mask: of the pixels with kVisibleAlpha or more, either more than 0.1 % are
/// from 2/255 to 253/255 (other values are noise of 8 bits around 0 and 1), or none is opaque. False without
/// a channel A.
bool has_soft_alpha(const Image& image);

/// Returns the pixels inside both masks, of one size; empty() counts as all.
Mask in_both(const Mask& a, const Mask& b);

/// Returns the image with alpha 0 outside the mask, 1 inside if it has no alpha yet.
Image hidden_outside(const Image& image, const Mask& mask);

/// Returns the pixels where the image of a mask is at least `threshold`. Its alpha counts, unless it has none
/// or all of it is opaque; then Y counts, or the mean of R, G and B, as encoded. Never empty(): all pixels
/// may be inside. Throws Error(kUnsupported) for an image with none of these channels.
Mask image_mask(const Image& image, float threshold);

}  // namespace imgmesh
