// Samples that are infinite or no number. Internal to this room.
#pragma once

#include <cstdint>

#include "libcore/image/image.h"

namespace imgmesh {

/// Index of the first pixel whose sample of the channel is not finite; pixel_count() if there is none.
std::size_t first_non_finite(const Image& image, int channel);

/// Sets such samples of the channel to 0; returns how many there were.
std::int64_t zero_non_finite(Image& image, int channel);

/// Gives them the value of the nearest pixel where it is finite, by distance of centres; of equally near ones
/// of the leftmost column, and in a column the upper one. Returns how many there were, or -1 if no sample of
/// the channel is finite. Takes O(pixels) time (Felzenszwalb and Huttenlocher, "Distance Transforms of
/// Sampled Functions", 2012).
std::int64_t fill_non_finite(Image& image, int channel);

}  // namespace imgmesh
