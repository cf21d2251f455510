#include "libcore/pipeline/lod_meshes.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace imgmesh {
namespace {

// Kept meshes are 1.5 % apart, up to a third finer than requested: predictions may be that far off. If meshes
// are not small compared with the image, keeping them would take too much memory.
constexpr double kStep = 0.015, kReach = 1.35, kSmall = 1.0 / 16;

std::int64_t count_of(const SimplifyResult& level) {
    return static_cast<std::int64_t>(level.mesh.vertex_count());
}

}  // namespace

LodMeshes::LodMeshes(const GridMesh& grid, std::function<SimplifyParams(std::int64_t)> params,
                     const Progress& progress)
    : grid_(grid), params_(std::move(params)), progress_(progress) {}

SimplifyResult LodMeshes::mesh(std::int64_t vertices, bool lods) {
    for (const SimplifyResult& level : kept_)
        if (count_of(level) <= vertices &&
            static_cast<double>(count_of(level)) >= (1 - kStep) * static_cast<double>(vertices) - 1)
            return level;
    // A run that has ended early has nothing coarser.
    if (!run_ || reached_ < vertices) {
        run_.reset();  // frees its memory before the next run starts
        kept_.clear();
        run_.emplace(grid_, params_(vertices));
        reached_ = std::numeric_limits<std::int64_t>::max();
        ++runs_;
    }
    const double most = kSmall * static_cast<double>(grid_.vertex_count());
    if (lods) {
        std::erase_if(kept_, [&](const SimplifyResult& level) {
            return static_cast<double>(count_of(level)) > kReach * static_cast<double>(vertices);
        });
        std::vector<std::int64_t> counts;
        for (double n = static_cast<double>(vertices) * (1 + kStep);
             n < std::min(most, kReach * static_cast<double>(vertices)); n *= 1 + kStep)
            if (counts.empty() || static_cast<std::int64_t>(n) > counts.back())
                counts.push_back(static_cast<std::int64_t>(n));
        for (; !counts.empty(); counts.pop_back()) {
            if (counts.back() >= reached_ || counts.back() <= vertices) continue;
            kept_.push_back(run_->to({.vertices = counts.back()}, progress_));
            reached_ = count_of(kept_.back());
        }
    }
    SimplifyResult level = run_->to({.vertices = vertices}, progress_);
    reached_ = count_of(level);
    if (lods && static_cast<double>(reached_) < most) kept_.push_back(level);
    return level;
}

}  // namespace imgmesh
