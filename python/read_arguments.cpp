#include "python/read_arguments.h"

#include <pybind11/stl.h>

#include "libcore/base/error.h"
#include "python/words.h"

namespace imgmesh::python {

namespace py = pybind11;

namespace {

// Returns the value as T. Throws a TypeError that names the argument.
template <typename T>
T value_as(const char* name, const py::object& value, const char* expected) {
    try {
        return value.cast<T>();
    } catch (const py::cast_error&) {
        throw py::type_error(cat(name, ": expected ", expected, ", found ", std::string(py::repr(value))));
    }
}

// Takes the argument out and returns its value as T, or none.
template <typename T>
std::optional<T> take_as(py::dict& arguments, const char* name, const char* expected) {
    const py::object value = take(arguments, name);
    if (value.is_none()) return std::nullopt;
    return value_as<T>(name, value, expected);
}

}  // namespace

py::object take(py::dict& arguments, const char* name) {
    return arguments.contains(name) ? arguments.attr("pop")(name) : py::none();
}

ReadImageOptions take_read_options(py::dict& arguments) {
    ReadImageOptions options;
    options.color_space = word_value("color_space", take_as<std::string>(arguments, "color_space", "a word"),
                                     color_space_choices());
    options.part = take_as<std::string>(arguments, "part", "a name");
    options.layer = take_as<std::string>(arguments, "layer", "a name");
    options.non_finite = word_value("non_finite", take_as<std::string>(arguments, "non_finite", "a word"),
                                    non_finite_choices())
                             .value_or(NonFinite::kRefuse);
    options.values = take_as<bool>(arguments, "values", "True or False").value_or(false);
    const py::object nodata = take(arguments, "nodata");
    if (py::isinstance<py::str>(nodata)) {
        if (std::string(py::str(nodata)) != "none")
            throw Error(ErrorKind::kBadArgument, "nodata: expected a number, or 'none'");
        options.file_nodata = false;
    } else if (!nodata.is_none()) {
        options.file_nodata = false;
        options.nodata = value_as<double>("nodata", nodata, "a number, or 'none'");
    }
    if (const auto pixels = take_as<std::int64_t>(arguments, "max_pixels", "a whole number")) {
        if (*pixels < 1)
            throw Error(ErrorKind::kBadArgument, cat("max_pixels is ", *pixels, ", expected at least 1"));
        options.limits.max_pixels = *pixels;
        options.limits.max_pixels_per_byte = 0;  // images up to there are wanted, however few bytes hold them
    }
    return options;
}

void refuse_others(const char* function, const py::dict& arguments, const py::list& known) {
    if (arguments.empty()) return;
    const auto first = py::reinterpret_borrow<py::object>(arguments.begin()->first);
    const py::list near = py::module_::import("difflib").attr("get_close_matches")(first, known, 1);
    std::string text = cat(function, "() has no parameter '", std::string(py::str(first)), "'");
    if (!near.empty()) text += cat("; did you mean '", std::string(py::str(near[0])), "'?");
    throw py::type_error(text);
}

}  // namespace imgmesh::python
