// The collapse by dense quadrics, apart from collapse_edges.cpp so that both compile side by side.
#include "libcore/simplify/simplifier.h"

namespace imgmesh {

template class Collapser<DenseQuadric<3>>;
template class Collapser<DenseQuadric<8>>;
template class Collapser<DenseQuadric<16>>;

}  // namespace imgmesh
