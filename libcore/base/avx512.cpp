// Apart from has_avx2(), so that a program may decide on one of them alone.
#include "libcore/base/simd.h"

namespace imgmesh {

bool has_avx512() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#else
    return false;
#endif
}

}  // namespace imgmesh
