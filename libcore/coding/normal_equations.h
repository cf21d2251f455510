// The least-squares fit of vertex colours to a picture, as a system that vertices leave one by one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libcore/coding/face_moments.h"

namespace imgmesh::coding {

class NormalEquations {
  public:
    /// Takes the moments of image channels; the unknowns are in coded channels (color_transform.h).
    NormalEquations(const CodedShape& shape, std::span<const FaceMoments> moments, int channels);

    /// Gauss-Seidel over all vertices.
    void solve(int sweeps);
    /// Gauss-Seidel over the neighbours of a vertex that come after it, and theirs.
    void settle_after(std::size_t vertex);

    /// Size V * channels.
    std::span<const double> values() const { return value_; }
    double value(std::size_t vertex, std::size_t channel) const {
        return value_[vertex * channels_ + channel];
    }
    void set(std::size_t vertex, std::size_t channel, double value) {
        value_[vertex * channels_ + channel] = value;
    }
    /// Returns how the squared error grows with that of the vertex, if the vertices after it make up for it.
    double stiffness(std::size_t vertex) const;
    /// Returns the squared error of the drawing.
    double error() const;

  private:
    struct Term {
        Id vertex;
        double gram;
    };
    void relax(std::size_t vertex);

    std::size_t channels_;
    std::vector<std::uint32_t> first_;
    std::vector<Term> terms_;
    std::vector<double> own_, right_, value_;
    double total_ = 0;
};

}  // namespace imgmesh::coding
