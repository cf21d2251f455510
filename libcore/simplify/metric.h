// The error that decides which edges collapse, and the way its minimum is found.
#pragma once

#include <string_view>

namespace imgmesh {

/// What a face's quadric measures at a point of the plane with features.
enum class Metric {
    kFlattened,  ///< the paper (sec. 3.2): distance to the centroid, and to the features at that position
    kHoppe,      ///< Hoppe 1999 on a flat mesh: distance to the features at that position alone
    kGarland     ///< Garland and Heckbert 1998: distance to the face's plane among positions and features
};

/// How A v = -b is solved for the vertex v of least error (paper, table 1).
enum class Solver {
    kClosed,  ///< features eliminated first; what remains is 2x2
    kSvd,     ///< singular value decomposition of the whole matrix
    kLu       ///< LU decomposition of the whole matrix, with full pivoting
};

constexpr std::string_view metric_name(Metric metric) {
    return metric == Metric::kFlattened ? "flattened" : metric == Metric::kHoppe ? "hoppe" : "garland";
}
constexpr std::string_view solver_name(Solver solver) {
    return solver == Solver::kClosed ? "closed" : solver == Solver::kSvd ? "svd" : "lu";
}

}  // namespace imgmesh
