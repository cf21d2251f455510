// The arguments of functions that read images.
#pragma once

#include <pybind11/pybind11.h>

#include "formats/picture/image_io.h"

namespace imgmesh::python {

/// Takes color_space, part, layer, channels, non_finite, values, nodata and max_pixels out of `arguments` and
/// returns the options that they mean. Throws Error(kBadArgument) for a word that is none, and what Python
/// raises for another type.
ReadImageOptions take_read_options(pybind11::dict& arguments);

/// Takes an argument out of `arguments`; None where it is not there.
pybind11::object take(pybind11::dict& arguments, const char* name);

/// Throws a TypeError for the first of the arguments that are left, with the name among `known` that was
/// probably meant.
void refuse_others(const char* function, const pybind11::dict& arguments, const pybind11::list& known);

}  // namespace imgmesh::python
