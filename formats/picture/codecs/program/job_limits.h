// Time and memory of one job.
#pragma once

#include <cstdint>

namespace imgmesh {

/// Limits the memory and the processor time of this process from now on. `samples` is the number of the
/// image's samples (width x height x channels), `input_bytes` the size of what it is read from. The limits
/// are some times what any codec needs, and at least 512 MiB and 60 s.
void limit_job(std::uint64_t samples, std::uint64_t input_bytes);

}  // namespace imgmesh
