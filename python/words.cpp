#include "python/words.h"

namespace imgmesh::python {

Choices<SampleType> dtype_names() {
    return {{"uint8", SampleType::kUint8},
            {"uint16", SampleType::kUint16},
            {"float16", SampleType::kHalf},
            {"float32", SampleType::kFloat}};
}

}  // namespace imgmesh::python
