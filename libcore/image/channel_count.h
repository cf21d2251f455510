// The numbers of features that code is compiled for.
#pragma once

#include <type_traits>
#include <utility>

#include "libcore/image/feature_space.h"

namespace imgmesh {

/// The numbers of features that templates are compiled for. Other numbers are padded with features of value
/// zero, which change no error.
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
