// From the dense mesh to the base mesh by edge collapses in order of the quadric error (paper sec. 3.1
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

/// Where a level of the pyramid ends; whichever limit comes first.
struct SimplifyTarget {
    std::int64_t vertices = 0;  ///< at this many vertices
    std::int64_t faces = 0;     ///< or at this many faces
    double face_share = 0;      ///< or at this share of the faces of the level before
    /// no collapse above this total quadric error [feature units^2 px^2]
    double max_error = std::numeric_limits<double>::infinity();
};

struct SimplifyResult {
    BaseMesh mesh;               ///< vertices in the order of their pixels; positions on kPositionStep
    double error = 0;            ///< largest total quadric error of a merged vertex so far
    std::int64_t collapses = 0;  ///< so far
};

/// A collapse that is about to happen: `removed` merges into `kept`, which moves. Vertices are numbered as in
/// the grid mesh.
struct CollapseStep {
    Id kept, removed;
    float x, y;                      ///< of the merged vertex [pixels]
    std::span<const float> feature;  ///< of the merged vertex; perhaps with zeros behind the grid's channels
};

/// Who follows the collapse while it runs; both may be empty, and cost nothing then.
struct SimplifyHooks {
    /// Before each collapse, in order. Returns false to reject it: the edge is tried again only when
    /// something around it has changed.
    std::function<bool(const CollapseStep&)> before;
    /// When a level's target is reached, with its result (features perhaps padded likewise), before the
    /// collapse goes on to the next.
    std::function<void(std::size_t level, const SimplifyResult&)> reached;
};

/// Collapses edges until a limit is reached or no edge may go. Every collapse keeps the mesh a triangulation
/// of the image's rectangle: no face flips or degenerates, corners stay, sides stay straight. Vertices sit
/// at their quadric's minimiser wherever that is legal, else at the edge's midpoint or an end, whichever
/// costs least.
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

/// The same, one target after the other: where it goes on may depend on what came of it so far.
class SimplifyRun {
  public:
    /// `grid` must live as long as the run.
    SimplifyRun(const GridMesh& grid, const SimplifyParams& params);
    ~SimplifyRun();
    /// On from where it stands, to a target at least as coarse as the last.
    SimplifyResult to(const SimplifyTarget& target, const Progress& progress = {});

  private:
    std::unique_ptr<AnySimplifier> simplifier_;
};

/// The mesh of a single level.
SimplifyResult simplify(const GridMesh& grid, const SimplifyParams& params, const SimplifyTarget& target,
                        const Progress& progress = {});

}  // namespace imgmesh
