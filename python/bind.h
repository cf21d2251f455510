// The parts of the Python module. Each adds classes and functions of one theme to it.
#pragma once

#include <pybind11/pybind11.h>

namespace imgmesh::python {

namespace py = pybind11;

void bind_errors(py::module_& module);
void bind_image(py::module_& module);
void bind_container(py::module_& module);
void bind_build(py::module_& module);
void bind_draw(py::module_& module);
void bind_segment(py::module_& module);
void bind_warp(py::module_& module);
void bind_compare(py::module_& module);

}  // namespace imgmesh::python
