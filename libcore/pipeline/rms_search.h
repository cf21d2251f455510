// How far a collapse may go for a wanted error of the reconstruction.
#pragma once

#include <cstdint>

namespace imgmesh {

/// What a search needs of the meshes between which it chooses.
class MeasuredMeshes {
  public:
    struct Probe {
        std::int64_t vertices;  ///< of the mesh: about as many as asked for
        double rms;             ///< its error
    };
    virtual ~MeasuredMeshes() = default;
    /// A mesh of at most `vertices`, or the coarsest there is, finished. Cheap only where numbers fall, or
    /// rise by a third at most.
    virtual Probe finished(std::int64_t vertices) = 0;
    /// The mesh of the last call of finished() is the best so far.
    virtual void keep() = 0;
    /// About the error that finished() would tell, at a fraction of the cost.
    virtual Probe estimated(std::int64_t vertices) = 0;
};

/// Finds as few vertices as an error of at most `rms` takes, to about 3 %: by the power law that errors of
/// photographs follow, with the numbers of vertices that are known to be too few and enough as bounds.
/// Usually two meshes are finished, none but cheap ones far from the goal. Where errors do not fall steadily,
/// the mesh found still has an error of at most `rms`.
///
/// vertices  of the dense mesh, >= 4
/// guess     where to begin; rather too many
/// return    false where even the dense mesh has a larger error: keep() was never called
bool search_rms(std::int64_t vertices, std::int64_t guess, double rms, MeasuredMeshes& meshes);

}  // namespace imgmesh
