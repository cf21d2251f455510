// The small value types that every part of the library shares.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

namespace imgmesh {

using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;
using Vec2d = Eigen::Vector2d;
using Vec3d = Eigen::Vector3d;

/// Ids of vertices, faces and pixels, counted from 0. kNone stands for "no vertex", "no face" and so on.
using Id = std::uint32_t;
inline constexpr Id kNone = 0xFFFFFFFFu;

/// The three corners of a triangle, counter-clockwise as seen on screen.
using Face = std::array<Id, 3>;

}  // namespace imgmesh
