// Checks the header and the pixels of a part of the layers. Internal to exr_layers.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "formats/exr/exr_layers.h"
#include "formats/exr/exr_part_header.h"

namespace imgmesh {

inline constexpr const char *kVersionName = "imgmesh:version", *kTopologyName = "imgmesh:topology",
                            *kLayersVersion = "1.0";
inline constexpr const char *kFace = "face.id", *kU = "bary.u", *kV = "bary.v", *kVisits = "visit.count";

inline bool on_grid(const PixelCoord& c, float step) {
    const float u = c.u / step, v = c.v / step;  // exact: a power of two
    return u == std::floor(u) && v == std::floor(v);
}

inline bool in_simplex(const PixelCoord& c) {
    // In double, because the sum of two floats in [0, 1] that exceeds 1 is then never rounded down to 1.
    return c.u >= 0 && c.v >= 0 && double(c.u) + double(c.v) <= 1;
}

/// Compares the header of part `name` with the expected one.
void check_part_header(const ExrPartHeader& header, const std::string& name, const ExpectedLayers& expected,
                       Findings& findings);

/// Checks the pixels, rounds weights of any origin to the grid, and sets the precision.
void finish_part(LayerPart& part, bool stored_as_half, std::uint64_t faces, bool has_mask,
                 Findings& findings);

}  // namespace imgmesh
