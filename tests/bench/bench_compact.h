// The compact stream of an image's map: its size, and the time of one thread both ways.
#pragma once

#include <string>

namespace imgmesh::bench {

struct CompactFigures {
    double bits_per_pixel = 0;
    double encode_megapixels = 0, decode_megapixels = 0;  ///< a second, of the fastest run
};

/// Builds the image at `path` with default parameters, rounds its pixels' positions to multiples of 1 / steps
/// pixel, and encodes and decodes these displacements `repeats` times. Throws Error, also if what comes back
/// is not what was encoded.
CompactFigures measure_compact(const std::string& path, int steps, int repeats);

}  // namespace imgmesh::bench
