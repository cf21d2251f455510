// Conversions of numbers to indices, ids and counts. Each names its purpose and is checked in builds with
// assertions.
#pragma once

#include <cassert>
#include <concepts>
#include <cstddef>
#include <limits>
#include <utility>

#include "libcore/base/types.h"

namespace imgmesh {

/// For indices and sizes of containers; not negative.
template <std::integral T>
constexpr std::size_t as_index(T number) {
    assert(std::cmp_greater_equal(number, 0));
    return static_cast<std::size_t>(number);
}

/// For loops over rows, and for libraries that count in int: below 2^31.
template <std::integral T>
constexpr int as_int(T number) {
    assert(std::in_range<int>(number));
    return static_cast<int>(number);
}

/// For the number of a vertex, a face or a pixel.
template <std::integral T>
constexpr Id as_id(T number) {
    assert(std::cmp_greater_equal(number, 0) && std::cmp_less(number, kNone));
    return static_cast<Id>(number);
}

}  // namespace imgmesh
