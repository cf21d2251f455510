// The parts of the Python module. Each adds classes and functions of one theme to it.
#pragma once

#include <pybind11/pybind11.h>

namespace imgmesh::python {

namespace py = pybind11;

/// Makes TypeErrors of Class() and of Class.__new__(Class): only functions of imgmesh make one. pybind11
/// alone would let Python have an object without a value. Casts from C++ do not go this way.
void refuse_new(py::handle type);
/// Makes an object that has its value, or none, of all ways to have a new object of a class with a
/// constructor.
void construct_in_new(py::handle type);

void bind_errors(py::module_& module);
void bind_image(py::module_& module);
void bind_container(py::module_& module);
void bind_build(py::module_& module);
void bind_draw(py::module_& module);
void bind_segment(py::module_& module);
void bind_warp(py::module_& module);
void bind_compare(py::module_& module);
void bind_coded(py::module_& module);

}  // namespace imgmesh::python
