// Ranges of parameters, and how messages tell them.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "libcore/base/error.h"

namespace imgmesh {

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Whole numbers from `least` to `most`.
struct CountRange {
    std::int64_t least = 0;
    std::int64_t most = std::numeric_limits<std::int64_t>::max();
};

/// Finite numbers from `least` to `most`; without `least` itself where `open`.
struct NumberRange {
    double least = 0;
    double most = kNoLimit;
    bool open = false;
};

constexpr bool contains(const CountRange& range, std::int64_t value) {
    return value >= range.least && value <= range.most;
}

inline bool contains(const NumberRange& range, double value) {
    return std::isfinite(value) && value <= range.most &&
           (range.open ? value > range.least : value >= range.least);
}

/// What a value of the range is, as in "a whole number from 1 to 32".
inline std::string describe(const CountRange& range) {
    if (range.most >= std::numeric_limits<int>::max()) return cat("a whole number, at least ", range.least);
    return cat("a whole number from ", range.least, " to ", range.most);
}

inline std::string describe(const NumberRange& range) {
    std::string words = cat("a number ", range.open ? "above " : "of at least ", range.least);
    if (std::isfinite(range.most)) words += cat(" and at most ", range.most);
    return words;
}

}  // namespace imgmesh
