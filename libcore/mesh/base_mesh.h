// The base mesh: the small triangle mesh that represents an image.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "libcore/base/index.h"

namespace imgmesh {

/// Vertex positions are multiples of this step [pixels], so Draco's quantisation loses nothing
/// (docs/format.md).
inline constexpr float kPositionStep = 1.0f / 32.0f;

/// Returns the multiple of kPositionStep nearest to x [pixels].
inline float snapped(float x) {
    return std::round(x / kPositionStep) * kPositionStep;
}

/// An indexed triangle mesh over the image plane with features (colours) at its vertices.
///
/// Positions are in pixels, x right, y down (image.h), and multiples of kPositionStep. Faces run
/// counter-clockwise as seen on screen: signed_area2() > 0 for each.
struct BaseMesh {
    int channels = 3;             ///< features per vertex
    std::vector<Vec2f> position;  ///< size V [pixels]
    std::vector<float> feature;   ///< size V * channels, interleaved; colour as L*u*v*
    std::vector<Face> faces;      ///< size F

    std::size_t vertex_count() const { return position.size(); }
    const float* feature_of(Id v) const { return feature.data() + std::size_t{v} * as_index(channels); }
    float* feature_of(Id v) { return feature.data() + std::size_t{v} * as_index(channels); }
};

/// Returns twice the signed area of triangle (a, b, c) in pixels^2. It is positive if the corners run
/// counter-clockwise on screen, and exact for positions on the kPositionStep grid.
inline double signed_area2(const Vec2f& a, const Vec2f& b, const Vec2f& c) {
    const double abx = double(b.x()) - a.x(), aby = double(b.y()) - a.y();
    const double acx = double(c.x()) - a.x(), acy = double(c.y()) - a.y();
    return aby * acx - abx * acy;
}

/// Returns every edge once, its lower vertex first, in ascending order. Takes O(F log F) time.
std::vector<std::pair<Id, Id>> mesh_edges(const BaseMesh& mesh);

}  // namespace imgmesh
