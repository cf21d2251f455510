// Numbers from text, strictly: what is not wholly a number in range is refused with Error(kBadArgument), in a
// line that names the option, the value and what is expected.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

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

/// `text` as a value of option `name`. Plain decimal digits; no sign but '-', no space, no other base.
std::int64_t parse_count(const std::string& name, const std::string& text, const CountRange& range);
/// Decimal with optional exponent; neither infinite nor nan.
double parse_number(const std::string& name, const std::string& text, const NumberRange& range);

}  // namespace imgmesh
