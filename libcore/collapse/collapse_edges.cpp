// Steps: (1) a quadric for every vertex; (2) edges are filed by the error that merging their ends would add;
// (3) the cheapest edge whose merge keeps the mesh a triangulation is collapsed, and the edges around it are
// filed anew; (4) until a limit is reached. Sources: paper sec. 3.1, 3.2; Garland and Heckbert 1997; Hoppe
// 1999.
#include "libcore/collapse/collapse_edges.h"

#include <algorithm>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/collapse/collapser.h"
#include "libcore/image/channel_count.h"

namespace imgmesh {

// Compiled in dense_collapser.cpp.
extern template class Collapser<DenseQuadric<3>>;
extern template class Collapser<DenseQuadric<8>>;
extern template class Collapser<DenseQuadric<16>>;

namespace {

// The first channels of every item, or all and zeros behind them.
std::vector<float> with_channels(const std::vector<float>& values, int from, int to) {
    const std::size_t items = values.size() / static_cast<std::size_t>(from);
    std::vector<float> out(items * static_cast<std::size_t>(to), 0.0f);
    for (std::size_t i = 0; i < items; ++i)
        std::copy_n(values.data() + i * static_cast<std::size_t>(from), std::min(from, to),
                    out.data() + i * static_cast<std::size_t>(to));
    return out;
}

template <class Q>
std::vector<CollapseResult> collapse_by(const GridMesh& grid, const CollapseParams& params,
                                        std::span<const CollapseTarget> targets, const Progress& progress,
                                        const CollapseHooks& hooks) {
    Collapser<Q> collapser(grid, params, hooks);
    std::vector<CollapseResult> levels;
    for (const CollapseTarget& target : targets) {
        collapser.run(target, progress);
        levels.push_back(collapser.snapshot());
        if (hooks.reached) hooks.reached(levels.size() - 1, levels.back());
    }
    return levels;
}

// grid.feature has C channels.
template <int C>
std::vector<CollapseResult> collapse(const GridMesh& grid, const CollapseParams& params,
                                     std::span<const CollapseTarget> targets, const Progress& progress,
                                     const CollapseHooks& hooks) {
    if (params.metric == Metric::kFlattened && params.solver == Solver::kClosed)
        return collapse_by<Quadric<C>>(grid, params, targets, progress, hooks);
    return collapse_by<DenseQuadric<C>>(grid, params, targets, progress, hooks);
}

}  // namespace

std::vector<CollapseResult> collapse_edges(const GridMesh& grid, const CollapseParams& params,
                                           std::span<const CollapseTarget> targets, const Progress& progress,
                                           const CollapseHooks& hooks) {
    const int channels = grid.feature.channels;
    if (channels < 1 || channels > kMaxFeatures)
        throw Error(ErrorCode::kUsage, cat(channels, " features, expected 1 to ", kMaxFeatures));
    return with_padded_features(channels, [&](auto padded) {
        constexpr int kPadded = padded();
        if (channels == kPadded) return collapse<kPadded>(grid, params, targets, progress, hooks);
        GridMesh wide = grid;
        wide.feature.channels = kPadded;
        wide.feature.data = with_channels(grid.feature.data, channels, kPadded);
        std::vector<CollapseResult> levels = collapse<kPadded>(wide, params, targets, progress, hooks);
        for (CollapseResult& level : levels) {
            level.mesh.channels = channels;
            level.mesh.feature = with_channels(level.mesh.feature, kPadded, channels);
        }
        return levels;
    });
}

CollapseResult collapse_edges(const GridMesh& grid, const CollapseParams& params,
                              const CollapseTarget& target, const Progress& progress) {
    return std::move(collapse_edges(grid, params, std::span(&target, 1), progress).front());
}

}  // namespace imgmesh
