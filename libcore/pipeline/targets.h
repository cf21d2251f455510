// Whether a build has reached what was asked for.
#pragma once

#include <string>
#include <vector>

#include "libcore/pipeline/build.h"

namespace imgmesh {

/// Returns a line for each number in `params` that the result has not reached: "5000 faces were wanted, the
/// mesh of all pixels has 162". Empty if all are reached.
///
/// A limit counts as reached where the mesh has that many vertices, or that many faces or one less (a
/// collapse on the boundary takes one face, any other two), or an RMS error of at most that. Of several
/// limits one is enough. Each further level is to have a quarter of the faces of the level before, rounded
/// down, but never less than two. Levels that a build has left out, as they would be the same as others, are
/// missed. Limits that a build never exceeds (error, level-errors, max-cluster, min-quality) are not missed.
///
/// density  whether params.stop.density was asked for, if no other limit counts: else it is only the default
std::vector<std::string> missed_targets(const BuildParams& params, const BuildResult& result, bool density);

}  // namespace imgmesh
