// Triangles inside polygons.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/outline.h"

namespace imgmesh {

/// Returns a mesh (positions and faces, no features) of the area inside `loops`, whose vertices are its
/// vertices in their order: n vertices and h holes in k parts give n + 2 h - 2 k faces. Its inner edges are
/// locally Delaunay.
///
/// loops  simple and without crossings; points may be shared. Outer ones run counter-clockwise on screen,
/// holes
///        clockwise; on kPositionStep
///
/// Takes O(n^2) time. Throws Error(kInternal) if the loops are not what they must be.
BaseMesh triangulated(const std::vector<Loop>& loops);

}  // namespace imgmesh
