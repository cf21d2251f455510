// A tracker that follows the collapse, if the map or the visits need one.
#pragma once

#include <optional>
#include <vector>

#include "libcore/param/track.h"
#include "libcore/pipeline/build_params.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh {

/// For one run of simplify. Visits alone must not change the mesh. Then pixels stay at their places in the
/// image, which forbids no collapse, and are counted when a collapse changes their face.
class Tracking {
  public:
    /// grid  the dense mesh of an image of width x height pixels
    Tracking(const GridMesh& grid, int width, int height, const BuildParams& params);
    Tracking(const Tracking&) = delete;  // hooks() point here
    Tracking& operator=(const Tracking&) = delete;

    const SimplifyHooks& hooks() const { return hooks_; }
    /// Returns whether the maps are the tracker's.
    bool tracked() const { return tracked_; }
    PixelMap take_map(std::size_t level) { return std::move(maps_[level]); }
    /// Returns the visits down to the finest level; empty if not requested.
    std::vector<Id> take_visits() { return std::move(visits_); }
    std::int64_t rejected() const { return tracker_ ? tracker_->rejected() : 0; }

  private:
    bool tracked_;
    std::optional<PixelTracker> tracker_;
    std::vector<PixelMap> maps_;
    std::vector<Id> visits_;
    SimplifyHooks hooks_;
};

}  // namespace imgmesh
