#include "libcore/pipeline/tracking.h"

#include "libcore/param/track_start.h"

namespace imgmesh {

Tracking::Tracking(const GridMesh& grid, int width, int height, const BuildParams& params)
    : tracked_(map_kind(params) == MapKind::kTracked) {
    if (!tracked_ && !params.visits) return;
    TrackParams track;
    track.space = tracked_ ? TrackSpace::kConformal : TrackSpace::kPlane;
    track.color_weight = tracked_ ? map_color_weight(params) : 0;
    tracker_.emplace(track_start(grid, width, height), track);
    hooks_.before = [this](const CollapseStep& step) {
        return tracker_->collapse(step.kept, step.removed, {step.x, step.y}, step.feature);
    };
    hooks_.reached = [this, visits = params.visits](std::size_t level, const SimplifyResult& result) {
        if (tracked_) maps_.push_back(tracker_->map(result.mesh));
        if (visits && level == 0) visits_ = tracker_->visits();
    };
}

}  // namespace imgmesh
