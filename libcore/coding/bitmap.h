// Pictures of 8 bits a sample.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace imgmesh {

/// Rows from the top, channels interleaved: grey, grey and alpha, RGB or RGBA, encoded as sRGB. Alpha is not
/// premultiplied.
struct Bitmap {
    int width = 0, height = 0;
    int channels = 3;                ///< 1 to 4
    std::vector<std::uint8_t> data;  ///< size width * height * channels

    bool has_alpha() const { return channels == 2 || channels == 4; }
};

}  // namespace imgmesh
