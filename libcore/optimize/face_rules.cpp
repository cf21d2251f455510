#include "libcore/optimize/face_rules.h"

#include <algorithm>

#include "libcore/image/color.h"

namespace imgmesh {

FaceRules::FaceRules(const FaceLimits& limits, double shape_unit)
    : limits_(limits),
      shape_unit_(shape_unit),
      most_area2_(2 * limits.max_area * kPlacesPerPixel * kPlacesPerPixel),
      plain_(limits.fatness == 0 && limits.min_quality == 0 && shape_unit == 0 &&
             limits.max_area == std::numeric_limits<double>::infinity()) {}

Double4 FaceRules::nearest(const Double4& color) const {
    if (limits_.colors == ColorLimits::kUnit) {
        Double4 out = color;
        for (int c = 0; c < 4; ++c) out[c] = std::clamp(double{color[c]}, 0.0, 255.0);
        return out;
    }
    const Vec3f luv =
        in_gamut({static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])});
    return Double4{luv[0], luv[1], luv[2], 0};
}

}  // namespace imgmesh
