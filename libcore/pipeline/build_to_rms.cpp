#include "libcore/pipeline/build_to_rms.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libcore/base/stopwatch.h"
#include "libcore/pipeline/lod_meshes.h"
#include "libcore/pipeline/params.h"
#include "libcore/pipeline/rms_search.h"

namespace imgmesh {
namespace {

// Final error / error of an estimate: a mesh without refinement whose pixels have moved for one round. 0.75
// to 0.9 on photographs with the usual refinement. A wrong value costs at worst one more finished mesh.
constexpr double kEstimateShare = 0.85;

// Meshes for the search by a wanted error.
class RmsMeshes : public MeasuredMeshes {
  public:
    RmsMeshes(const BuildStages& stages, SimplifyParams& limits, MeshImage& mesh_image)
        : stages_(stages),
          limits_(limits),
          collapsing_(part_of(stages.progress, 0, 0.7)),
          lods_(
              stages.grid, [this](std::int64_t vertices) { return limits_for(vertices); }, collapsing_),
          mesh_image_(mesh_image) {}

    Probe finished(std::int64_t vertices) override {
        SimplifyResult collapsed = collapse(vertices, true);
        collapses_ = collapsed.collapses;
        level_ = stages_.finish(std::move(collapsed), limits_, {}, figures_, 0.7, 1);
        // The search is in features.
        return {static_cast<std::int64_t>(level_.mesh.vertex_count()),
                figures_.map_rms * static_cast<double>(stages_.space.unit)};
    }
    void keep() override {
        mesh_image_.levels.clear();
        mesh_image_.levels.push_back(std::move(level_));
        stages_.report.levels = {figures_};
        stages_.report.collapses = collapses_;
        limits_.smoothing = smoothing_;
    }
    Probe estimated(std::int64_t vertices) override {
        SimplifyResult collapsed = collapse(vertices, false);
        const auto count = static_cast<std::int64_t>(collapsed.mesh.vertex_count());
        return {count, kEstimateShare * stages_.estimated_rms(std::move(collapsed))};
    }

  private:
    SimplifyResult collapse(std::int64_t vertices, bool lods) {
        Stopwatch watch;
        SimplifyResult collapsed = lods_.mesh(vertices, lods);
        stages_.report.seconds.collapse += watch.lap();
        return collapsed;
    }
    SimplifyParams limits_for(std::int64_t vertices) {
        SimplifyParams limits = limits_;
        limits.smoothing = smoothing_ = collapse_params(stages_.params, {.vertices = vertices},
                                                        static_cast<double>(stages_.report.pixels))
                                            .smoothing;
        return limits;
    }

    const BuildStages& stages_;
    SimplifyParams& limits_;
    int smoothing_ = 0;  // of the present run
    Progress collapsing_;
    LodMeshes lods_;
    MeshImage& mesh_image_;
    Level level_;
    LevelReport figures_;
    std::int64_t collapses_ = 0;
};

}  // namespace

void build_to_rms(const BuildStages& stages, SimplifyParams& limits, MeshImage& mesh_image) {
    const GridMesh& grid = stages.grid;
    const double rms = *stages.params.stop.rms;
    mesh_image.levels.clear();
    // All vertices of the dense mesh: strips of one pixel have more vertices than pixels.
    const auto vertices = grid.mask.empty()
                              ? static_cast<std::int64_t>(grid.vertex_count())
                              : stages.report.pixels + static_cast<std::int64_t>(grid.copies.size());
    // Photographs reach an RMS of 3.8 with 1 % of their pixels. The search starts with more than most
    // need.
    constexpr double kUsualRms = 3.8, kUsualShare = 0.01, kAhead = 5, kPower = 2.6, kMost = 1.0 / 8;
    const double share = kAhead * kUsualShare * std::pow(kUsualRms / std::max(rms, 1e-3), kPower);
    const double guess = std::clamp(share, 1.0 / 4096, kMost) * static_cast<double>(vertices);
    RmsMeshes meshes(stages, limits, mesh_image);
    // Without success, the search ends with the mesh of all vertices.
    if (!search_rms(std::max(std::int64_t{4}, vertices), std::llround(guess), rms, meshes)) meshes.keep();
}

}  // namespace imgmesh
