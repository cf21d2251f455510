// The attributes of an EXR as a Python dict.
#pragma once

#include <pybind11/pybind11.h>

#include "formats/exr/exr_metadata.h"

namespace imgmesh::python {

/// Returns name -> text, number, or a tuple of numbers.
pybind11::dict metadata_dict(const ExrMetadata& metadata);

}  // namespace imgmesh::python
