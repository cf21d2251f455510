// Translates the parameters of a build for its stages.
#pragma once

#include <vector>

#include "libcore/param/fit_map.h"
#include "libcore/pipeline/build_params.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh {

/// Throws Error(kBadArgument) for the first parameter out of its range, and where parameters exclude each
/// other.
void check_params(const BuildParams& params);

/// Returns the collapse's targets, finest level first, for an image of that many pixels.
std::vector<SimplifyTarget> collapse_targets(const BuildParams& params, double pixels);

/// Returns the collapse's parameters except max_face_area.
SimplifyParams collapse_params(const BuildParams& params, const SimplifyTarget& finest, double pixels);

/// `params` as they shaped the result: nothing that was left to the build is open any more.
BuildParams closed_params(const BuildParams& params, const SimplifyParams& collapse,
                          WeightPrecision precision);

/// Returns the rounds of refinement: the chosen number, else none for published metrics and for the quadrics'
/// colours, which are compared unrefined, and for a tracked map, which must end with the collapse.
std::int64_t refine_rounds(const BuildParams& params);

/// Returns the refinement's parameters except max_face_area.
RefineParams refine_params(const BuildParams& params);

/// Returns the parameters of the pixel map and the colours, for features of that space.
FitParams fit_params(const BuildParams& params, const FeatureSpace& space);

}  // namespace imgmesh
