#include "python/errors.h"

#include <filesystem>
#include <new>

#include "libcore/base/error.h"
#include "python/bind.h"

namespace imgmesh::python {
namespace {

// Classes of imgmesh/_errors.py, which live as long as the process.
PyObject* class_of(const char* name) {
    return py::object(py::module_::import("imgmesh._errors").attr(name)).release().ptr();
}

const char* class_name(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::kBadArgument:
            return "ArgumentError";
        case ErrorKind::kIo:
            return "FileError";
        case ErrorKind::kBadFile:
            return "BadFileError";
        case ErrorKind::kUnsupported:
            return "UnsupportedError";
        case ErrorKind::kInternal:
            break;
    }
    return "InternalError";
}

void translate(std::exception_ptr thrown) {
    try {
        std::rethrow_exception(thrown);
    } catch (const Error& e) {
        PyErr_SetString(class_of(class_name(e.kind())), e.what());
    } catch (const std::filesystem::filesystem_error& e) {
        PyErr_SetString(class_of("FileError"), cat(e.path1().string(), ": ", e.code().message()).c_str());
    } catch (const std::bad_alloc&) {
        PyErr_SetString(class_of("OutOfMemoryError"), "out of memory");
    }
}

}  // namespace

void warn(const std::vector<std::string>& texts) {
    constexpr int kCaller = 1;
    for (const std::string& text : texts)
        if (PyErr_WarnEx(class_of("Warning"), text.c_str(), kCaller) != 0) throw py::error_already_set();
}

void tell_missed(const std::string& name, const std::vector<std::string>& missed, bool strict,
                 std::vector<std::string>& warnings) {
    for (const std::string& line : missed) {
        if (strict) throw Error(ErrorKind::kUnsupported, cat(name, ": ", line));
        warnings.push_back(cat(name, ": ", line));
    }
}

void bind_errors(py::module_&) {
    py::register_local_exception_translator(translate);
}

}  // namespace imgmesh::python
