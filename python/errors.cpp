#include "python/errors.h"

#include <filesystem>
#include <new>

#include "libcore/base/error.h"
#include "python/bind.h"
#include "tools/common/text.h"

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

// A text that may hold names of files, which are bytes, as one line that every Python can print.
py::str line_of(const std::string& text) {
    const std::string line = printable_line(text);
    return py::reinterpret_steal<py::str>(
        PyUnicode_DecodeUTF8(line.data(), static_cast<py::ssize_t>(line.size()), "backslashreplace"));
}

void set_error(PyObject* type, const std::string& text) {
    PyErr_SetObject(type, line_of(text).ptr());
}

void translate(std::exception_ptr thrown) {
    try {
        std::rethrow_exception(thrown);
    } catch (const Error& e) {
        set_error(class_of(class_name(e.kind())), e.what());
    } catch (const py::cast_error& e) {
        set_error(PyExc_TypeError, e.what());
    } catch (const std::filesystem::filesystem_error& e) {
        set_error(class_of("FileError"), cat(e.path1().string(), ": ", e.code().message()));
    } catch (const std::bad_alloc&) {
        PyErr_SetString(class_of("OutOfMemoryError"), "out of memory");
    }
}

}  // namespace

void warn(const std::vector<std::string>& texts) {
    constexpr int kCaller = 1;
    for (const std::string& text : texts)
        if (PyErr_WarnEx(class_of("Warning"), std::string(line_of(text)).c_str(), kCaller) != 0)
            throw py::error_already_set();
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
