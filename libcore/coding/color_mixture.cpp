#include "libcore/coding/color_mixture.h"

#include <algorithm>

#include "libcore/coding/integer_math.h"

namespace imgmesh::coding {
namespace {

constexpr std::int64_t kFar = 14 * 1024;  // nothing is left there

}  // namespace

std::int32_t ColorMixture::below(std::int32_t value) const {
    std::int32_t sum = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const Part& p = parts_[i];
        const std::int32_t apart = value - p.place;
        const std::int64_t far = std::int64_t{apart < 0 ? -apart : apart} * p.rate >> 14;
        const std::int32_t half = half_power(static_cast<std::int32_t>(std::min(far, kFar))) >> 1;
        sum += p.weight * (apart < 0 ? half : (1 << 14) - half);
    }
    return sum;
}

}  // namespace imgmesh::coding
