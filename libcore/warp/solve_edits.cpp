#include "libcore/warp/solve_edits.h"

#include <cmath>

#include "libcore/base/error.h"
#include "libcore/warp/live_edits.h"

namespace imgmesh {

EditSolution edit_solution(const MeshImage& mesh_image, const WarpEdits& edits) {
    return LiveEdits(mesh_image).solve(edits);
}

std::vector<std::string> missed_places(const EditSolution& solution) {
    std::vector<std::string> lines;
    for (std::size_t level = 0; level < solution.left.size(); ++level)
        if (solution.left[level] > 0)
            lines.push_back(
                cat("level ", level, ": a handle stays ", std::ceil(solution.left[level] * 100) / 100,
                    " pixels short of its place: no mesh without folds was found that has it there; "
                    "smaller moves, fewer pins or a finer level may do"));
    return lines;
}

std::vector<VertexMoves> solve_edits(const MeshImage& mesh_image, const WarpEdits& edits) {
    return edit_solution(mesh_image, edits).moves;
}

}  // namespace imgmesh
