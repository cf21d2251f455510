// All that can be said against a container, not only the first thing.
#pragma once

#include <string>
#include <vector>

#include "formats/findings/issue.h"
#include "formats/findings/limits.h"

namespace imgmesh {

/// Runs the checks of read_container to their end, inside the Draco meshes and the EXR and across all three,
/// and those for warnings and infos. What a finding makes meaningless is not looked at: without a size no
/// pixels. The first error is the one with which read_container refuses the file; no errors mean that it
/// reads the file. Throws Error(kIo) where a file cannot be read.
std::vector<Issue> validate_container(const std::string& path, const ContainerLimits& limits = {});

}  // namespace imgmesh
