// The library's choice of processor, made again: as if there was no AVX2.
#include "libcore/base/simd.h"

namespace imgmesh {

bool has_avx2() {
    return false;
}

}  // namespace imgmesh
