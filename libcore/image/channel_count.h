// How many features a pixel or vertex may have, and for how many of them code is compiled.
#pragma once

#include <type_traits>
#include <utility>

namespace imgmesh {

/// Features of a pixel or vertex at most.
inline constexpr int kMaxFeatures = 16;

/// The numbers of features that templates are compiled for. Between them features of value zero fill up,
/// which change no error.
constexpr int padded_features(int features) {
    return features <= 3 ? 3 : features <= 8 ? 8 : kMaxFeatures;
}

/// Calls function(std::integral_constant<int, padded_features(features)>()).
template <typename Function>
decltype(auto) with_padded_features(int features, Function&& function) {
    switch (padded_features(features)) {
        case 3:
            return std::forward<Function>(function)(std::integral_constant<int, 3>());
        case 8:
            return std::forward<Function>(function)(std::integral_constant<int, 8>());
        default:
            return std::forward<Function>(function)(std::integral_constant<int, kMaxFeatures>());
    }
}

}  // namespace imgmesh
