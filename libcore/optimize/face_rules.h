// What an optimisation allows a face and a colour to be, and what a bad shape costs.
#pragma once

#include <limits>

#include "libcore/optimize/fan_fit.h"

namespace imgmesh {

/// The colours that a vertex may have.
enum class ColorLimits {
    kAny,
    kUnit,  ///< 0 to 255 in each channel
    kLuv    ///< those of a container (in_gamut)
};

struct FaceLimits {
    double fatness = 0;      ///< each face has more than this times its longest edge as height
    double min_quality = 0;  ///< no new face has a lesser q = 4 sqrt(3) area / sum of squared edges
    double max_area = std::numeric_limits<double>::infinity();  ///< no new face is larger [px^2]
    ColorLimits colors = ColorLimits::kAny;
};

/// Judges faces. All faces are positive.
class FaceRules {
  public:
    FaceRules() = default;
    /// shape_unit  what a face costs for each unit of 1/q - 1 [squared error]
    FaceRules(const FaceLimits& limits, double shape_unit);

    /// Returns whether the face may be made, and what its shape costs.
    IMGMESH_INLINE bool admits(const Place& a, const Place& b, const Place& c, double& cost) const {
        cost = 0;
        const std::int64_t area = area2(a, b, c);
        return area > 0 && (plain_ || admits(a, b, c, static_cast<double>(area), cost));
    }
    /// What the shape of a face costs that is there.
    IMGMESH_INLINE double shape_cost(const Place& a, const Place& b, const Place& c) const {
        double cost = 0;
        if (!plain_) admits(a, b, c, static_cast<double>(area2(a, b, c)), cost);
        return cost;
    }
    /// Whether the faces of a fan may be made around `at`; sets their costs and the sum.
    IMGMESH_INLINE bool admits(const Fan& fan, const Place& at, FanFit& fit) const {
        fit.shape_cost = 0;
        for (std::size_t k = 0; k < fan.faces; ++k) {
            if (!admits(at, fan.spot[k].place, fan.spot[k + 1].place, fit.shape[k])) return false;
            fit.shape_cost += fit.shape[k];
        }
        return true;
    }
    /// The allowed colour near another one.
    IMGMESH_INLINE Double4 allowed(const Double4& color) const {
        return limits_.colors == ColorLimits::kAny ? color : nearest(color);
    }
    bool limits_colors() const { return limits_.colors != ColorLimits::kAny; }

  private:
    IMGMESH_INLINE bool admits(const Place& a, const Place& b, const Place& c, double area,
                               double& cost) const {
        const double abx = b.x - a.x, aby = b.y - a.y, bcx = c.x - b.x, bcy = c.y - b.y, cax = a.x - c.x,
                     cay = a.y - c.y;
        const double ab = abx * abx + aby * aby, bc = bcx * bcx + bcy * bcy, ca = cax * cax + cay * cay;
        const double longest = ab > bc ? (ab > ca ? ab : ca) : (bc > ca ? bc : ca), sum = ab + bc + ca;
        cost = shape_unit_ > 0 ? shape_unit_ * (sum / (kEqual * area) - 1) : 0;
        return area > limits_.fatness * longest && area <= most_area2_ &&
               kEqual * area >= limits_.min_quality * sum;
    }
    Double4 nearest(const Double4& color) const;

    static constexpr double kEqual = 3.4641016151377544;  // 2 sqrt(3)
    FaceLimits limits_;
    double shape_unit_ = 0, most_area2_ = 0;
    bool plain_ = true;
};

}  // namespace imgmesh
