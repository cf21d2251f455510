// Validation: everything that is wrong with a container, not only the first thing.
#pragma once

#include <string>
#include <vector>

#include "formats/findings/issue.h"
#include "formats/findings/limits.h"

namespace imgmesh {

/// Runs all checks of read_container() to their end, in the glTF document, in the Draco meshes, in the EXR
/// and between them, and further checks for warnings and infos. Checks that a finding makes meaningless are
/// left out: without the image's size those of its pixels.
///
/// return  the findings in the order of the checks. The first error is the one for which read_container()
///         refuses the file; it reads every file without an error.
///
/// Safe for any bytes. Takes O(bytes + pixels + faces log faces) time. Throws Error(kIo) if a file cannot be
/// read.
std::vector<Issue> validate_container(const std::string& path, const ContainerLimits& limits = {});

}  // namespace imgmesh
