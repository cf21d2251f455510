// The stages of a build, of writing and of reading, one after the other in this process, each measured.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "libcore/pipeline/build.h"
#include "tests/bench/usage_meter.h"

namespace imgmesh::bench {

struct StageRow {
    std::string stage;
    Usage usage;      ///< of the run that took the least processor time
    double rms = -1;  ///< of what the stage has made [L*u*v*], where that has one; -1 elsewhere
};

/// Measures each stage `repeats` times on the image at `path`; containers go into `folder`. `params` has
/// one level. Throws Error.
std::vector<StageRow> measure_stages(const std::string& path, const std::string& folder,
                                     const BuildParams& params, int repeats);

}  // namespace imgmesh::bench
