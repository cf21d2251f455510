// Source: docs/decisions/0012-refinement.md. One round:
//   1. edges flip where that lowers the squared error (flips.cpp)
//   2. vertices are relocated (relocate.cpp, removals.cpp, insertions.cpp)
//   3. vertices move by Gauss-Newton steps on position and own colour (moves.cpp)
//   4. all colours are fitted by least squares (refiner.cpp)
#include "libcore/refine/refine.h"

#include "libcore/refine/refiner.h"

namespace imgmesh {

// Rounds end when one gains less than this share of the error.
constexpr double kLeastGain = 1e-4;

RefineReport refine(BaseMesh& mesh, const FeatureImage& image, const RefineParams& params,
                    const Progress& progress, const Mask& mask) {
    const ImagePlanes planes(image, mask);
    Refiner refiner(mesh, planes, params);
    mesh = refiner.result();
    RefineReport report;
    report.error.push_back(refiner.total_error());
    for (int round = 0; round < params.rounds; ++round) {
        if (progress) progress(static_cast<double>(round) / params.rounds, "refine");
        if (params.relocations > 0) {
            const Refiner::Rewired rewired = refiner.flip_and_relocate();
            report.flips += rewired.flips;
            report.relocations += rewired.relocations;
        } else {
            report.flips += refiner.flip_edges();
        }
        report.moves += refiner.move_vertices();
        refiner.fit_colors();
        // A step may raise the error for a better shape; a round may not.
        const double error = refiner.total_error();
        if (!(error < report.error.back())) break;
        report.error.push_back(error);
        mesh = refiner.result();
        const double before = report.error[report.error.size() - 2];
        if (before - error < kLeastGain * before) break;
    }
    // A relocated vertex has the number of the removed one, somewhere else.
    if (report.error.size() > 1 && params.relocations > 0) mesh = numbered_downwards(mesh);
    return report;
}

}  // namespace imgmesh
