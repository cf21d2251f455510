#include "libcore/image/color_levels.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/index.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

double code_of(double encoded) {
    const auto x = static_cast<float>(encoded);
    return 65535.0 * double{linear_from_encoded(ColorSpace::kSrgb, Vec3f(x, x, x))[0]};
}

}  // namespace

ColorLevels::ColorLevels(int count) {
    const double steps = count - 1;
    for (int k = 0; k < count; ++k) {
        code_.push_back(static_cast<std::uint16_t>(std::lround(code_of(k / steps))));
        first_.push_back(k == 0 ? std::uint16_t{0}
                                : static_cast<std::uint16_t>(std::ceil(code_of((k - 0.5) / steps))));
    }
}

std::uint16_t ColorLevels::nearest(std::uint16_t code) const {
    return code_[as_index(static_cast<int>(std::ranges::upper_bound(first_, code) - first_.begin()) - 1)];
}

Vec3f ColorLevels::rounded(const Vec3f& luv) const {
    auto codes = color_codes(luv);
    for (std::uint16_t& code : codes) code = nearest(code);
    return color_from_codes(codes);
}

}  // namespace imgmesh
