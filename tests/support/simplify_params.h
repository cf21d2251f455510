// What the tests simplify with.
#pragma once

#include "libcore/simplify/simplify_params.h"

namespace imgmesh::test {

/// Geometry counts enough for well-shaped triangles even without refinement, so that what is tested does not
/// hang on slivers. (A build refines, and has less.)
inline SimplifyParams plain_params(Metric metric = Metric::kFlattened, Solver solver = Solver::kClosed) {
    SimplifyParams params;
    params.metric = metric;
    params.solver = solver;
    params.geometry_weight = 3;
    params.smoothing = 2;
    return params;
}

template <typename Change>
SimplifyParams plain_params_but(Change change, Metric metric = Metric::kFlattened) {
    SimplifyParams params = plain_params(metric);
    change(params);
    return params;
}

}  // namespace imgmesh::test
