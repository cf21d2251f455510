#include "libcore/coding/color_mixture.h"

#include "libcore/coding/integer_math.h"

namespace imgmesh::coding {

std::int32_t ColorMixture::below(std::int32_t value) const {
    std::int32_t sum = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        const Part& p = parts_[i];
        const std::int32_t apart = value - p.place;
        const std::int32_t half = half_power(1024 * (apart < 0 ? -apart : apart) / p.half) >> 1;
        sum += p.weight * (apart < 0 ? half : (1 << 14) - half);
    }
    return sum;
}

}  // namespace imgmesh::coding
