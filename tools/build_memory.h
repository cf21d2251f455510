// How much memory a build takes.
#pragma once

#include "libcore/image/image.h"
#include "libcore/pipeline/build_params.h"

namespace imgmesh {

/// What a build takes for each pixel of an image, beside 8 bytes for each channel that is read [bytes].
double build_bytes_of_pixel(const BuildParams& params);

/// What it takes in all to build a container from an image [bytes]; measured as in docs/limits.md.
double build_memory(const Image& image, const BuildParams& params);

}  // namespace imgmesh
