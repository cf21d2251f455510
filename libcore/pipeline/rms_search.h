// Finds how far a collapse may go for a wanted error of the reconstruction.
#pragma once

#include <cstdint>

namespace imgmesh {

/// What a search needs to know about the meshes among which it chooses.
class MeasuredMeshes {
  public:
    struct Probe {
        std::int64_t vertices;  ///< of the mesh: about the requested number
        double rms;             ///< its error
    };
    virtual ~MeasuredMeshes() = default;
    /// Returns a finished mesh of at most `vertices`, or the coarsest one possible. Cheap only if numbers
    /// fall, or rise by at most a third.
    virtual Probe finished(std::int64_t vertices) = 0;
    /// Keeps the mesh of the last call of finished(): it is the best so far.
    virtual void keep() = 0;
    /// Estimates the error that finished() would return, at a fraction of the cost.
    virtual Probe estimated(std::int64_t vertices) = 0;
};

/// Finds about the least number of vertices (to 3 %) with an error of at most `rms`. It uses the power law
/// that errors of photographs follow, with the numbers of vertices known to be too few and enough as bounds.
/// Usually two meshes are finished, and only cheap ones are far from the goal. If errors do not fall
/// steadily, the mesh found still has an error of at most `rms`.
///
/// vertices  of the dense mesh, >= 4
/// guess     where to start; rather too many
/// return    false if even the dense mesh has a larger error; then keep() was never called, and the last call
/// of
///           finished() was for all vertices
bool search_rms(std::int64_t vertices, std::int64_t guess, double rms, MeasuredMeshes& meshes);

}  // namespace imgmesh
