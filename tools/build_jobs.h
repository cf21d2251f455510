// Which container each image of imgmesh-build goes to.
#pragma once

#include <string>
#include <vector>

#include "tools/build_options.h"

namespace imgmesh {

struct Job {
    std::string input;
    std::string output;
};

/// Throws Error(kBadArgument) for what can be seen to be wrong before any work: an output that is no
/// container, two images for one container, an output that would replace an input.
std::vector<Job> plan_jobs(const BuildOptions& options);

}  // namespace imgmesh
