// Steps: (1) a quadric for every vertex; (2) edges are filed by the error that merging their ends would add;
// (3) the cheapest edge whose merge keeps the mesh a triangulation is collapsed, and the edges around it are
// filed anew; (4) until a limit is reached. Sources: paper sec. 3.1, 3.2; Garland and Heckbert 1997; Hoppe
// 1999.
#include "libcore/collapse/collapse_edges.h"

#include <utility>

#include "libcore/collapse/collapser.h"

namespace imgmesh {

std::vector<CollapseResult> collapse_edges(const GridMesh& grid, const CollapseParams& params,
                                           std::span<const CollapseTarget> targets, const Progress& progress,
                                           const CollapseHooks& hooks) {
    Collapser<Quadric<3>> collapser(grid, params, hooks);
    std::vector<CollapseResult> levels;
    for (const CollapseTarget& target : targets) {
        collapser.run(target, progress);
        levels.push_back(collapser.snapshot());
        if (hooks.reached) hooks.reached(levels.size() - 1, levels.back());
    }
    return levels;
}

CollapseResult collapse_edges(const GridMesh& grid, const CollapseParams& params,
                              const CollapseTarget& target, const Progress& progress) {
    return std::move(collapse_edges(grid, params, std::span(&target, 1), progress).front());
}

}  // namespace imgmesh
