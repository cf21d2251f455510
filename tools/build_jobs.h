// The container for each image of imgmesh-build.
#pragma once

#include <string>
#include <vector>

#include "tools/build_options.h"

namespace imgmesh {

struct Job {
    std::string input;
    std::string output;
};

/// Throws Error(kBadArgument) for mistakes that can be found before any work: an output that is not a
/// container, two images for one container, an output that would replace an input.
std::vector<Job> plan_jobs(const BuildOptions& options);

}  // namespace imgmesh
