// The taps that predict a part best. Internal to this room.
#pragma once

#include <cstdint>
#include <span>

#include "formats/compact/residual_model.h"

namespace imgmesh::compact {

/// Fits the taps of one component to a sample of its pixels, for the least sum of absolute residuals. The
/// cost does not grow with the image. Too few pixels give taps that serve on average.
Taps fit_taps(std::span<const std::int16_t> values, int width, int height);

}  // namespace imgmesh::compact
