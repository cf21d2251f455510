// The library's choice of processor, made again: as if there was no AVX-512.
#include "libcore/base/simd.h"

namespace imgmesh {

bool has_avx512() {
    return false;
}

}  // namespace imgmesh
