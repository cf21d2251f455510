// Pixel maps whose positions lie on a grid, as one compact stream in memory: the other layout of a
// container's layers, beside the EXR. docs/format.md describes it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/exr/exr_layers.h"
#include "libcore/mesh/displacements.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

class Findings;

/// One part of the stream: a level's displacements, and the visit map if there is one.
struct CompactPart {
    std::string name;  ///< "lod0", ...
    Displacements map;
    WeightPrecision precision = WeightPrecision::kFloat;  ///< of the pixel map that it stands for
    std::vector<Id> visits;                               ///< size width * height, or empty
    std::string topology;  ///< hash of the map's mesh: 64 digits, lower-case hex; empty if there is none
};

/// A part to encode, whose pixels lie elsewhere.
struct CompactView {
    std::string name;
    const Displacements* map;
    WeightPrecision precision;
    std::span<const Id> visits;
    std::string topology;
};

/// Encodes parts without loss, on all threads. Equal parts give equal bytes, for any number of threads and
/// for any of the steps 8, 16 and 32 that hold the displacements. Throws Error(kInternal) for what a part
/// cannot be: sizes that disagree, a displacement outside the mask, a name of more than 255 bytes.
std::vector<std::uint8_t> encode_compact_layers(const std::vector<CompactView>& parts);
std::vector<std::uint8_t> encode_compact_layers(const std::vector<CompactPart>& parts);

/// Decodes the parts in the order of `expected`, on all threads. A map comes back with the coarsest steps of
/// 8, 16 and 32 that hold it, and without a mask if all pixels are inside. Safe for any bytes: what the
/// headers say is compared with `expected` before memory is taken for pixels, and there are no more than 1024
/// pixels for each byte. `expected.faces` is not used. Throws FindingError. With collecting findings, a part
/// with errors has no displacements.
std::vector<CompactPart> decode_compact_layers(std::span<const std::uint8_t> bytes,
                                               const ExpectedLayers& expected, Findings& findings);
/// The same with strict findings.
std::vector<CompactPart> decode_compact_layers(std::span<const std::uint8_t> bytes,
                                               const ExpectedLayers& expected);

/// Returns whether the bytes begin like a compact stream.
bool is_compact_stream(std::span<const std::uint8_t> bytes);

}  // namespace imgmesh
