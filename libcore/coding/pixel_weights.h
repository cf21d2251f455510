// Pixels that weigh more where a picture is smooth, as they do in SSIM.
#pragma once

#include <span>
#include <vector>

#include "libcore/coding/bitmap.h"
#include "libcore/coding/encode_picture.h"

namespace imgmesh::coding {

/// Returns how much the error of each pixel counts, with a mean of 1; nothing if all count the same, which is
/// so unless `tune` is kSsim, and for pictures of one row or column.
///
/// In SSIM an error counts less where luma varies (Wang, Bovik, Sheikh, Simoncelli 2004, eq. 13). Choice and
/// figures: docs/decisions/0045-coded-pictures.md.
/// samples  premultiplied(picture)
std::vector<float> pixel_weights(const Bitmap& picture, std::span<const float> samples, Tune tune);

}  // namespace imgmesh::coding
