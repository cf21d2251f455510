// Pixel maps as the parts of one EXR file, in memory.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

class Findings;

/// One part of the EXR: a level's pixel map, and the visit map if there is one.
struct LayerPart {
    std::string name;  ///< "lod0", ...
    PixelMap map;
    std::vector<Id> visits;  ///< size width * height, or empty
    std::string topology;    ///< hash of the map's mesh; empty if the file has none
};

/// A part to encode, whose pixels lie elsewhere.
struct LayerView {
    std::string name;
    const PixelMap* map;
    std::span<const Id> visits;
    std::string topology;
};

/// Encodes parts of one size: scanlines, ZIP, channels face.id (UINT), bary.u and bary.v (HALF or FLOAT by
/// map.precision) and visit.count (UINT). The same parts give the same bytes. Throws Error(kInternal) for a
/// weight off the grid of its precision or outside the simplex, which would not survive.
std::vector<std::uint8_t> encode_exr_layers(const std::vector<LayerView>& parts);
std::vector<std::uint8_t> encode_exr_layers(const std::vector<LayerPart>& parts);

/// What a reader knows about the EXR before it opens it.
struct ExpectedLayers {
    int width = 0;
    int height = 0;
    std::vector<std::string> parts;  ///< names, in the wanted order
    /// For each part: every face.id is below this, or kNone. If unknown (validator), the largest number.
    std::vector<std::uint64_t> faces;
    bool has_mask = false;  ///< whether kNone is allowed
};

/// Decodes and checks the parts. Safe for any bytes: everything in the headers is compared with `expected`
/// before memory is taken for pixels, and there are no more pixels than the bytes can hold. Weights of
/// other software are rounded down to multiples of kFloatWeightStep; the result's precision is the coarsest
/// grid that holds them all. Throws FindingError. With collecting findings, a part with errors has no
/// coords.
std::vector<LayerPart> decode_exr_layers(std::span<const std::uint8_t> bytes, const ExpectedLayers& expected,
                                         Findings& findings);
/// The same with strict findings.
std::vector<LayerPart> decode_exr_layers(std::span<const std::uint8_t> bytes, const ExpectedLayers& expected);

}  // namespace imgmesh
