// The collapse by matrix quadrics, apart from simplify.cpp so that both compile side by side.
#include "libcore/simplify/kernel/simplifier.h"

namespace imgmesh {

template class Simplifier<MatrixQuadric<3>>;
template class Simplifier<MatrixQuadric<kAnyChannels>>;

}  // namespace imgmesh
