# Headers of others that most of our files read, parsed once. Files still include what they use: ./run lint reads them
# without. CLI11 is not among them: g++ compiles its parser anew, for four seconds, in every file that has read it.
set(IMGMESH_PRECOMPILED_VALUES <Eigen/Core> <algorithm> <array> <cmath> <cstdint> <cstring> <functional> <limits>
  <memory> <numeric> <optional> <span> <sstream> <string> <string_view> <tuple> <utility> <vector>)
set(IMGMESH_PRECOMPILED_JSON ${IMGMESH_PRECOMPILED_VALUES} <nlohmann/json.hpp>)
set(IMGMESH_PRECOMPILED_TESTS ${IMGMESH_PRECOMPILED_VALUES} <doctest/doctest.h>)
