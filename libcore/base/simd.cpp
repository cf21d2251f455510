#include "libcore/base/simd.h"

namespace imgmesh {

bool has_avx2() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx2");
#else
    return false;
#endif
}

}  // namespace imgmesh
