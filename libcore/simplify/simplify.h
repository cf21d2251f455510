// Simplifies the dense mesh to the base mesh by edge collapses in order of the quadric error (paper sec. 3.1
// and 3.2).
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "libcore/base/progress.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/grid_mesh.h"
#include "libcore/simplify/simplify_params.h"

namespace imgmesh {

/// Where a level of the pyramid ends: at the first limit that is reached.
struct SimplifyTarget {
    std::int64_t vertices = 0;  ///< at this many vertices
    std::int64_t faces = 0;     ///< or at this many faces
    double face_share = 0;      ///< or at this share of the faces of the level before
    /// no collapse above this total quadric error [feature units^2 px^2]
    double max_error = std::numeric_limits<double>::infinity();
    /// no collapse that adds more than this to the error, or with SimplifyParams::total_priority whose total
    /// is above it [feature units^2 px^2]
    double max_increment = std::numeric_limits<double>::infinity();
};

struct SimplifyResult {
    BaseMesh mesh;               ///< vertices in the order of their pixels; positions on kPositionStep
    double error = 0;            ///< largest total quadric error of a merged vertex so far
    std::int64_t collapses = 0;  ///< so far
    double increment = 0;        ///< most that a collapse has cost so far, as max_increment has it
};

/// A collapse that is about to happen: `removed` merges into `kept`, which moves. Vertices are numbered as in
/// the grid mesh.
struct CollapseStep {
    Id kept, removed;
    float x, y;                      ///< of the merged vertex [pixels]
    std::span<const float> feature;  ///< of the merged vertex; perhaps with zeros behind the grid's channels
};

/// A collapse that has happened.
struct CollapseTaken {
    Vec2f ends[2], merged;  ///< places of the edge's ends and of the vertex that they have become [pixels]
    float increment;        ///< what it has added to the error, as SimplifyTarget::max_increment has it
};

/// Functions that follow the collapse; all may be empty, and then cost nothing.
struct SimplifyHooks {
    /// Before each collapse, in order. Returns false to reject it: the edge is tried again only when
    /// something around it has changed.
    std::function<bool(const CollapseStep&)> before;
    /// After each collapse, in order, but for those of the start in tiles, of which about an eighth of the
    /// dense mesh is left. The rest is then made without tiles, on one thread.
    std::function<void(const CollapseTaken&)> after;
    /// Called when a level's target is reached, with its result (features may be padded likewise), before the
    /// collapse continues.
    std::function<void(std::size_t level, const SimplifyResult&)> reached;
};

/// Collapses edges until a limit is reached or no collapse is possible. Every collapse keeps the mesh a
/// triangulation of the image's rectangle: no face flips or degenerates, corners stay, sides stay straight. A
/// vertex is placed at its quadric's minimiser if that is legal, else at the edge's midpoint or an end,
/// whichever costs least.
///
/// With GridMesh::side_vertices these and the corners are all that is left on the sides. What could not merge
/// along a side is taken out of the result, whose faces there are joined anew. (Error(kBadArgument) with
/// SimplifyHooks::before.)
///
/// targets  one a level, each at least as coarse as the one before
/// return   the mesh at each of the targets, in that order
///
/// Any number of features, 1 to kMaxFeatures (Error(kBadArgument) else). About 70 bytes a pixel with up to
/// three of them, 170 where it cannot begin in tiles (hooks, total priority, a goal above half the pixels),
/// 480 with another metric or solver than the first; O(n). Deterministic, with any number of threads.
std::vector<SimplifyResult> simplify(const GridMesh& grid, const SimplifyParams& params,
                                     std::span<const SimplifyTarget> targets, const Progress& progress = {},
                                     const SimplifyHooks& hooks = {});

class AnySimplifier;  // kernel/simplifier.h

/// The same, one target after the other: the next target may depend on earlier results.
class SimplifyRun {
  public:
    /// `grid` must outlive the run.
    SimplifyRun(const GridMesh& grid, const SimplifyParams& params);
    ~SimplifyRun();
    /// Continues to a target at least as coarse as the last.
    SimplifyResult to(const SimplifyTarget& target, const Progress& progress = {});

  private:
    std::unique_ptr<AnySimplifier> simplifier_;
};

/// Returns the mesh of a single level.
SimplifyResult simplify(const GridMesh& grid, const SimplifyParams& params, const SimplifyTarget& target,
                        const Progress& progress = {});

}  // namespace imgmesh
