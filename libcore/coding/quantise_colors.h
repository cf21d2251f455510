// The encoder's choice of colours: levels that draw the picture well for few bits.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "libcore/coding/color_plan.h"
#include "libcore/coding/face_moments.h"

namespace imgmesh::coding {

struct QuantisedColors {
    std::vector<int> level;           ///< size V * channels
    std::vector<std::int32_t> value;  ///< size V * channels: what the decoder has, in coded channels
    double bits = 0;                  ///< that the levels take
    double error = 0;  ///< squared error of the drawing, over pixels and channels [grey levels^2]
};

struct ColorChoice {
    std::array<std::int32_t, 4> steps{};       ///< of each coded channel [colour units]
    std::array<double, 4> weight{1, 1, 1, 1};  ///< of each coded channel's squared error
    /// Squared error [grey levels^2] that a bit may cost; .03 q^2 W H / V is best for steps of q grey levels.
    double bit_price = 0;
};

/// Chooses the levels of all vertices, in the order in which they are coded.
/// moments  of the faces of the shape (face_moments), in image channels
QuantisedColors quantise_colors(const CodedShape& shape, const ColorPlan& plan,
                                std::span<const FaceMoments> moments, int channels,
                                const ColorChoice& choice);

}  // namespace imgmesh::coding
