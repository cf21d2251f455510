// The decoder's drawing of a mesh. It is the same on every machine: integers only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libcore/base/types.h"
#include "libcore/coding/coded_mesh.h"

namespace imgmesh::coding {

/// Colours of decoded vertices are in 1/64 of a grey level.
inline constexpr int kColorUnit = 64;
/// Beyond this no decoded colour lies, below or above 0.
inline constexpr int kMaxColor = 1 << 16;

/// What is drawn: faces between points of a grid, as CodedMesh has them.
struct CodedShape {
    CodedGrid grid;
    std::span<const GridPoint> point;  ///< size V
    std::span<const Face> faces;       ///< size F
};

/// Draws the mesh at width x height pixels, which may differ from the grid's. Each face is linear in its
/// colours and draws the pixels whose centres lie in it or on its edges; a later face overwrites.
/// color     size V * channels, interleaved, in 1/kColorUnit of a grey level, |color| <= kMaxColor, times
/// alpha channels  1 to 4; the last of 2 and of 4 is alpha, by which the pixels are divided at the end
/// Returns width * height * channels bytes. At most 65535 pixels a side and 2^26 in all.
std::vector<std::uint8_t> draw_coded(const CodedShape& shape, std::span<const std::int32_t> color,
                                     int channels, int width, int height);

}  // namespace imgmesh::coding
