// Which pixels of an image belong to it: masked images of any shape and topology.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

/// One flag a pixel, rows from top to bottom; not 0 inside. Without pixels (the default) nothing is masked
/// out.
struct Mask {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> inside;  ///< size width * height

    bool empty() const { return inside.empty(); }
    bool contains(std::size_t pixel) const { return empty() || inside[pixel] != 0; }
    /// Whether pixel (x, y) is inside; false beyond the image. For a mask that is not empty().
    bool at(int x, int y) const {
        return x >= 0 && x < width && y >= 0 && y < height &&
               inside[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)] != 0;
    }
    std::int64_t count() const;  ///< pixels inside
};

/// The pixels of which alpha is at least `threshold`; empty() where the image has no channel A or all are.
Mask alpha_mask(const Image& image, float threshold);

/// The pixels of which a mask's image is at least `threshold`: its alpha, unless it has none or an opaque
/// one; then Y, or the mean of R, G and B, as encoded. Never empty(): all may be inside.
/// Throws Error(kUnsupported) for an image with none of these.
Mask image_mask(const Image& image, float threshold);

}  // namespace imgmesh
