// How Python makes objects of our classes.
#include "python/bind.h"

namespace imgmesh::python {
namespace {

PyObject* refuse(PyTypeObject* type, PyObject*, PyObject*) {
    PyErr_Format(PyExc_TypeError, "%s: only functions of imgmesh make one", type->tp_name);
    return nullptr;
}

// pybind11's own tp_new makes an object without a value, and __init__ gives it one. Type.__new__(Type) would
// return the former; so __init__ is called here, and does nothing the second time.
PyObject* construct(PyTypeObject* type, PyObject* arguments, PyObject* names) {
    PyObject* const object = type->tp_base->tp_new(type, arguments, names);
    if (object == nullptr) return nullptr;
    const int failed = type->tp_init(object, arguments, names);
    if (failed == 0) return object;
    Py_DECREF(object);
    return nullptr;
}

void set_new(py::handle type, newfunc make) {
    auto* const known = reinterpret_cast<PyTypeObject*>(type.ptr());
    known->tp_new = make;
    PyType_Modified(known);
}

}  // namespace

void refuse_new(py::handle type) {
    set_new(type, refuse);
}

void construct_in_new(py::handle type) {
    set_new(type, construct);
}

}  // namespace imgmesh::python
