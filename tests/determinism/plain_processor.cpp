// The library's choice of processor, made again: as if there was neither AVX2 nor AVX-512.
#include "libcore/base/simd.h"

namespace imgmesh {

bool has_avx2() {
    return false;
}

bool has_avx512() {
    return false;
}

}  // namespace imgmesh
