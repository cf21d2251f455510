// numpy arrays that show the memory of an object.
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <utility>
#include <vector>

namespace imgmesh::python {

/// Returns a read-only array over `data`, which belongs to `owner`; the array keeps it alive. strides are in
/// bytes.
template <typename T>
pybind11::array view(const pybind11::handle& owner, std::vector<pybind11::ssize_t> shape,
                     std::vector<pybind11::ssize_t> strides, const T* data) {
    pybind11::array array(pybind11::dtype::of<T>(), std::move(shape), std::move(strides), data, owner);
    array.attr("setflags")(pybind11::arg("write") = false);
    return array;
}

/// The same of values without gaps.
template <typename T>
pybind11::array view(const pybind11::handle& owner, std::vector<pybind11::ssize_t> shape, const T* data) {
    std::vector<pybind11::ssize_t> strides(shape.size(), sizeof(T));
    for (std::size_t d = shape.size(); d-- > 1;) strides[d - 1] = strides[d] * shape[d];
    return view(owner, std::move(shape), std::move(strides), data);
}

/// Returns an array that owns `values`.
template <typename T>
pybind11::array array_of(std::vector<T> values, std::vector<pybind11::ssize_t> shape) {
    auto owned = std::make_unique<std::vector<T>>(std::move(values));
    const T* data = owned->data();
    const pybind11::capsule owner(owned.release(),
                                  [](void* all) { delete static_cast<std::vector<T>*>(all); });
    return pybind11::array(pybind11::dtype::of<T>(), std::move(shape), data, owner);
}

}  // namespace imgmesh::python
