// What has been collapsed, or may be.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace imgmesh {

inline constexpr float kNever = std::numeric_limits<float>::infinity();

struct CollapseStats {
    /// taken away, without vertices of sides that must go (border_rules.h) and a face with each
    std::int64_t vertices = 0, faces = 0;
    std::int64_t due = 0;      ///< vertices of sides that were taken away because they must go
    double error = 0;          ///< largest total quadric error of a merged vertex
    float increment = 0;       ///< largest cost of a merge
    float postponed = kNever;  ///< least cost of the edges that are beyond the threshold

    void add(const CollapseStats& other) {
        vertices += other.vertices;
        faces += other.faces;
        due += other.due;
        error = std::max(error, other.error);
        increment = std::max(increment, other.increment);
        postponed = std::min(postponed, other.postponed);
    }
    /// Whether as much is taken away as may be.
    bool reached(const CollapseStats& may_go) const {
        return vertices >= may_go.vertices || faces >= may_go.faces;
    }
};

inline constexpr CollapseStats kAllMayGo{.vertices = std::numeric_limits<std::int64_t>::max(),
                                         .faces = std::numeric_limits<std::int64_t>::max()};

}  // namespace imgmesh
