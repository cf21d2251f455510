// What the colours of a mesh are predicted from and how finely they are coded, by its shape alone.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libcore/coding/draw_coded.h"

namespace imgmesh::coding {

struct ColorPlan {
    /// A neighbour that is coded before, and its share of the prediction, 1 to 4096: the largest is 4096.
    /// `flat` is the same to the power of 1/4.
    struct Neighbor {
        Id vertex;
        std::int32_t weight, flat;
    };
    static constexpr std::uint32_t kMostNeighbors = 12;

    std::vector<std::uint32_t> first;    ///< size V + 1: where a vertex's neighbours begin
    std::vector<Neighbor> neighbors;     ///< of each vertex, the latest first; at most kMostNeighbors of them
    std::vector<std::int32_t> fineness;  ///< size V: the step of a vertex over that of the mesh, in 1/4096

    std::size_t vertex_count() const { return fineness.size(); }
    std::span<const Neighbor> of(std::size_t vertex) const {
        return std::span(neighbors).subspan(first[vertex], first[vertex + 1] - first[vertex]);
    }
};

/// Plans a mesh whose vertices are in the order of coding: by row, then by column.
ColorPlan plan_colors(const CodedShape& shape);

}  // namespace imgmesh::coding
