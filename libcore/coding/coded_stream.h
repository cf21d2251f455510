// A coded picture as bytes. docs/codec-format.md describes them.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "libcore/coding/draw_coded.h"

namespace imgmesh::coding {

/// What a file says of a picture, in the order in which it says it.
struct StreamContent {
    CodedGrid grid;
    int channels = 3;
    std::vector<GridPoint> point;     ///< in raster order: by row, then by column
    std::vector<Face> faces;          ///< as the decoder finds them
    std::array<int, 4> step_index{};  ///< of each coded channel's step (color_step)
    std::vector<int> level;           ///< size V * channels
    std::vector<std::int32_t> color;  ///< size V * channels, in image channels [1 / kColorUnit]

    CodedShape shape() const { return {grid, point, faces}; }
};

inline constexpr int kStepIndices = 144;
/// Returns the step of a colour in colour units: 16 steps an octave, from a quarter of a grey level to 124.
constexpr std::int32_t color_step(int index) {
    return (16 + (index & 15)) << (index >> 4);
}

/// Largest picture: pixels, and pixels a side.
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 26;
inline constexpr int kMaxSide = 65535;

/// Returns how many vertices besides the corners a file of so many bytes may hold: far more than a picture
/// gets for them, so that a damaged file does not take much memory.
constexpr std::size_t most_vertices(std::size_t bytes) {
    return 4096 + 16 * bytes;
}

/// Returns the mesh as a decoder will have it, with points in raster order and without colours. Faces that
/// the format cannot reach are replaced; that happens to needles only.
StreamContent arranged(const CodedMesh& mesh);

/// Where the bytes of a file go; the parts share the bytes between them.
struct StreamSizes {
    std::size_t header = 0, points = 0, faces = 0, colors = 0;
};

/// Returns the bytes of a picture whose faces are those of arranged(). Sets its colours to the decoder's, and
/// `sizes` unless it is null.
std::vector<std::uint8_t> write_stream(StreamContent& content, StreamSizes* sizes = nullptr);

/// What the first bytes of a file say.
struct StreamHead {
    CodedGrid grid;
    int channels = 3;
};

/// Reads the first bytes of a file. Throws as read_stream() does.
StreamHead read_head(std::span<const std::uint8_t> bytes);
/// Reads a file. Throws Error(kBadFile) for bytes that are none or say what cannot be, and for more vertices
/// than `limit`, before memory is taken for it; Error(kUnsupported) for another version. Takes up to
/// 8 bytes of memory for each point of the grid, and 400 for each vertex.
StreamContent read_stream(std::span<const std::uint8_t> bytes,
                          std::size_t limit = std::numeric_limits<std::size_t>::max());

}  // namespace imgmesh::coding
