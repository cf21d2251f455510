// Reports everything that is wrong with a container, not only the first error.
#pragma once

#include <string>
#include <vector>

#include "formats/findings/issue.h"
#include "formats/findings/limits.h"

namespace imgmesh {

/// Runs all checks of read_container() to their end, inside the Draco meshes and the EXR and across all
/// three, and the checks for warnings and infos. It skips checks that a finding makes meaningless: no pixels
/// without a size. The first error is the one with which read_container() refuses the file; without errors it
/// reads the file. Throws Error(kIo) if a file cannot be read.
std::vector<Issue> validate_container(const std::string& path, const ContainerLimits& limits = {});

}  // namespace imgmesh
