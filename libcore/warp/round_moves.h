// Moves of vertices as they are stored, still without folds.
#pragma once

#include <span>
#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Whether every face with a positive area at rest has one with these moves, in exact arithmetic, and also if
/// all places are rounded to kPositionStep. Faces count only if is_used holds for their first corner.
bool keeps_faces(const BaseMesh& mesh, const std::vector<bool>& is_used, std::span<const Vec2f> moves);

/// Rounds the places of free vertices to kPositionStep, each to the nearest multiple, or to another within
/// two steps where a face needs it.
///
/// place  where every vertex is to be [pixels]
/// moves  of every vertex; those of vertices that are not free are given, the others are overwritten
/// return whether keeps_faces() holds then
bool round_moves(const BaseMesh& mesh, const std::vector<bool>& is_used, const std::vector<bool>& is_free,
                 std::span<const Vec2d> place, std::span<Vec2f> moves);

}  // namespace imgmesh
