// What an encoder's error is measured in.
#pragma once

#include <span>
#include <vector>

#include "libcore/base/grid.h"
#include "libcore/coding/bitmap.h"
#include "libcore/coding/encode_picture.h"
#include "libcore/coding/mesh_trial.h"

namespace imgmesh::coding {

/// Returns the picture's samples, 0 to 255, colours times alpha.
std::vector<float> premultiplied(const Bitmap& picture);

/// Returns the picture in channels whose squared error is what `tune` wants low. A side of one pixel becomes
/// one of two. samples  premultiplied(picture)
ChannelGrid objective(const Bitmap& picture, const std::vector<float>& samples, Tune tune);

/// Returns how channels of colour compare to that of lightness.
ColorWeights color_weights(Tune tune, int channels);

}  // namespace imgmesh::coding
