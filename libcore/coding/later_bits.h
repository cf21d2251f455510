// What a colour costs later: vertices that are predicted from it take more bits the farther it leads them
// astray.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "libcore/coding/color_plan.h"

namespace imgmesh::coding {

class LaterBits {
  public:
    /// step  of the mesh [grey levels]
    LaterBits(const ColorPlan& plan, std::size_t channels, double step);

    /// Takes a vertex, of which only later vertices are still open; value: size V * channels, what is chosen
    /// and what is likely [grey levels].
    void look_at(std::size_t vertex, std::span<const double> value);
    /// Returns about how many bits the vertices behind that one take if it has that colour.
    double operator()(std::size_t channel, double color) const;

  private:
    // A vertex that is predicted from another.
    struct Follower {
        Id vertex;
        double share, step;
    };
    const ColorPlan& plan_;
    std::size_t channels_;
    std::vector<double> weight_;  // of all neighbours, by vertex
    std::vector<std::uint32_t> first_;
    std::vector<Follower> followers_;
    std::span<const Follower> now_;
    std::vector<double> rest_;  // what `now_` would be off by if the vertex were 0, by follower and channel
};

}  // namespace imgmesh::coding
