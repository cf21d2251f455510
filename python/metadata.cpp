#include "python/metadata.h"

namespace imgmesh::python {

namespace py = pybind11;

py::dict metadata_dict(const ExrMetadata& metadata) {
    py::dict dict;
    for (const ExrAttribute& attribute : metadata) {
        py::object value = py::str(attribute.text);
        if (attribute.numbers.size() == 1) {
            value = py::float_(attribute.numbers[0]);
        } else if (attribute.numbers.size() > 1) {
            py::tuple all(attribute.numbers.size());
            for (std::size_t i = 0; i < attribute.numbers.size(); ++i) all[i] = attribute.numbers[i];
            value = all;
        }
        dict[py::str(attribute.name)] = value;
    }
    return dict;
}

}  // namespace imgmesh::python
