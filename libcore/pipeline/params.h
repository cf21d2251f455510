// What the parameters of a build mean to its stages.
#pragma once

#include <vector>

#include "libcore/pipeline/build.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh {

/// Throws Error(kBadArgument) for the first parameter that is out of its range.
void check_params(const BuildParams& params);

/// The collapse's targets, finest level first, for an image of that many pixels.
std::vector<SimplifyTarget> collapse_targets(const BuildParams& params, double pixels);

/// The collapse's parameters, but for max_face_area.
SimplifyParams collapse_params(const BuildParams& params, const SimplifyTarget& finest, double pixels);

/// Every parameter that shaped the result, by its option's name.
std::vector<BuildParameter> listed_params(const BuildParams& params, const SimplifyParams& collapse);

/// Rounds of refinement: as wanted, or else none for published metrics and for colours of the quadrics, which
/// are to be compared as they are, nor for a tracked map, which must end with the collapse.
std::int64_t refine_rounds(const BuildParams& params);

}  // namespace imgmesh
