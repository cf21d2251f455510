// imgmesh.Image, read_image() and write_image().
#include <pybind11/stl.h>

#include "formats/picture/image_io.h"
#include "python/bind.h"
#include "python/errors.h"
#include "python/image_value.h"
#include "python/metadata.h"
#include "python/read_arguments.h"
#include "python/views.h"
#include "python/words.h"
#include "python/work.h"

namespace imgmesh::python {
namespace {

const ImageValue& value_of(const py::object& self) {
    return *self.cast<std::shared_ptr<ImageValue>>();
}

// The samples in the file's own type; made once.
py::array array_property(const py::object& self) {
    constexpr char kCache[] = "_array";
    const py::dict own = self.attr("__dict__");
    if (!own.contains(kCache)) {
        py::array array = array_from(value_of(self).image);
        array.attr("setflags")(py::arg("write") = false);
        own[kCache] = array;
    }
    return own[kCache];
}

py::object as_array(const py::object& self, const py::object& dtype) {
    const py::array array = array_property(self);
    return dtype.is_none() ? py::object(array) : array.attr("astype")(dtype);
}

py::array samples(const py::object& self) {
    const Image& image = value_of(self).image;
    return view(self, {image.height, image.width, image.channels}, image.data.data());
}

py::object mask(const py::object& self) {
    const Mask& data = value_of(self).data;
    if (data.empty()) return py::none();
    return view(self, {data.height, data.width}, data.values.data()).attr("view")("bool");
}

ImagePointer make(const py::object& array, const std::optional<std::string>& color_space,
                  const std::vector<std::string>& channel_names, bool values) {
    return image_from_array(
        array_of_object(array, "array"),
        {word_value("color_space", color_space, color_space_choices()), channel_names, values}, "array");
}

std::shared_ptr<ImageValue> shared(const ImagePointer& image) {
    return std::const_pointer_cast<ImageValue>(image);  // nothing that is bound changes it
}

ImagePointer read(const py::object& path, const py::kwargs& given) {
    if (!is_path(path)) throw py::type_error("read_image(): expected a path");
    py::dict arguments = given.attr("copy")();
    const ReadImageOptions options = take_read_options(arguments);
    py::list known;
    for (const char* name : {"color_space", "part", "layer", "non_finite", "values", "nodata", "max_pixels"})
        known.append(name);
    refuse_others("read_image", arguments, known);
    std::vector<std::string> warnings;
    const ImagePointer image = image_from(path, options, "path", warnings);
    warn(warnings);
    return image;
}

void write(const py::object& path, const py::object& image, const std::optional<std::string>& dtype,
           const std::optional<std::string>& color_space, bool overwrite) {
    std::vector<std::string> warnings;
    if (is_path(image)) throw py::type_error("write_image(): expected an image or an array, found a path");
    ReadImageOptions meaning;
    meaning.color_space = word_value("color_space", color_space, color_space_choices());
    const ImagePointer value = image_from(image, meaning, "image", warnings);
    const WriteImageOptions options{overwrite, word_value("dtype", dtype, dtype_names()), value->metadata};
    const std::string name = path_text(path);
    without_gil({}, [&] {
        write_image(name, value->image, options);
        return true;
    });
}

constexpr char kImage[] = R"(Image(array, *, color_space=None, channel_names=(), values=False)

An image: samples, the meaning of their numbers, and what a file says beside them. It never changes.
numpy takes it as an array (numpy.asarray(image)), and so does matplotlib.

array           height x width, or height x width x channels. uint8 and uint16 are what a PNG holds, encoded as
                sRGB; float16, float32 and float64 are what an EXR holds, linear, with alpha not multiplied in.
                1 to 4 channels are grey, grey and alpha, RGB, RGBA. The samples are converted once to float32.
color_space     sRGB, linear, Rec709, Gamma2.2, AdobeRGB or DisplayP3; None: sRGB for integers, else linear
channel_names   names of any number of channels up to 64, such as R, G, B, depth.Z
values          the samples are data, not colours: integers keep their own numbers

Raises ArgumentError for another dtype or shape, BadFileError for samples that are not finite.)";

constexpr char kReadImage[] =
    R"(read_image(path, *, color_space=None, part=None, layer=None, non_finite='refuse', values=False, nodata=None,
           max_pixels=2**28) -> Image

Reads the first image of a PNG, JPEG, TIFF, EXR, WebP, GIF, BMP, PNM, TGA, Radiance HDR, JPEG 2000 or HEIF file
with all channels, as the tools do. The content decides, not the name.

color_space   of the image, whatever its file says
part, layer   of an EXR
non_finite    what becomes of samples that are infinite or no number: refuse, zero, nearest
values        the samples are data, not colours: integers keep their own numbers
nodata        the value of pixels that are no data, in the file's own numbers, or 'none'; None: what a TIFF names
max_pixels    larger images are refused

Raises FileError if the file cannot be read, BadFileError for a broken one, UnsupportedError for a kind that
imgmesh has no use for. What the image loses by being read is an imgmesh.Warning.)";

constexpr char kWriteImage[] = R"(write_image(path, image, *, dtype=None, color_space=None, overwrite=True)

Writes a PNG, JPEG, TIFF, WebP, EXR, BMP, PPM or PNM file, by the name's extension. The file appears whole or
not at all.

image         an Image, or an array as Image takes it
dtype         of the samples: uint8, uint16, float16 or float32; None: the image's, or the nearest of the format
color_space   of an array, as in Image

Raises ArgumentError for an extension that cannot be written or what its format cannot hold, FileError if the
file cannot be written, or exists and overwrite is False.)";

}  // namespace

void bind_image(py::module_& module) {
    py::class_<ImageValue, std::shared_ptr<ImageValue>> bound(module, "Image", py::dynamic_attr(),
                                                              py::is_final(), kImage);
    bound
        .def(py::init([](const py::object& array, const std::optional<std::string>& color_space,
                         const std::vector<std::string>& channel_names,
                         bool values) { return shared(make(array, color_space, channel_names, values)); }),
             py::arg("array"), py::kw_only(), py::arg("color_space") = py::none(),
             py::arg("channel_names") = std::vector<std::string>(), py::arg("values") = false)
        .def_property_readonly(
            "array", array_property,
            "The samples in the file's own dtype, height x width or height x width x channels; "
            "read-only. Integers are rounded codes; samples has what is computed with.")
        .def_property_readonly(
            "samples", samples,
            "The samples as float32, height x width x channels, integers scaled to [0, 1]: a "
            "read-only view without a copy.")
        .def_property_readonly(
            "mask", mask, "The pixels with data, height x width of bool, as a view; None if all have some.")
        .def_property_readonly(
            "width", [](const ImageValue& v) { return v.image.width; }, "In pixels.")
        .def_property_readonly(
            "height", [](const ImageValue& v) { return v.image.height; }, "In pixels.")
        .def_property_readonly(
            "shape", [](const py::object& self) { return array_property(self).attr("shape"); },
            "The shape of array.")
        .def_property_readonly(
            "dtype",
            [](const ImageValue& v) { return py::dtype(name_of(dtype_names(), v.image.sample_type)); },
            "The dtype of array.")
        .def_property_readonly(
            "channel_names", [](const ImageValue& v) { return py::tuple(py::cast(v.image.channel_names)); },
            "R, G, B, A or Y where that is what channels are, else a file's own names.")
        .def_property_readonly(
            "color_space",
            [](const ImageValue& v) { return std::string(color_space_name(v.image.color_space)); },
            "The colour space of the samples, such as 'sRGB'.")
        .def_property_readonly(
            "metadata", [](const ImageValue& v) { return metadata_dict(v.metadata); },
            "Attributes of an EXR by their names, as a new dict.")
        .def("__array__", as_array, py::arg("dtype") = py::none())
        .def("__repr__", [](const ImageValue& v) {
            std::string names;
            for (const std::string& name : v.image.channel_names) names += (names.empty() ? "" : ",") + name;
            return cat("<imgmesh.Image ", v.image.width, "x", v.image.height, " ", names, " ",
                       name_of(dtype_names(), v.image.sample_type), " ",
                       color_space_name(v.image.color_space), ">");
        });
    construct_in_new(bound);
    module.def(
        "read_image",
        [](const py::object& path, const py::kwargs& arguments) { return shared(read(path, arguments)); },
        py::arg("path"), kReadImage);
    module.def("write_image", write, py::arg("path"), py::arg("image"), py::kw_only(),
               py::arg("dtype") = py::none(), py::arg("color_space") = py::none(),
               py::arg("overwrite") = true, kWriteImage);
}

}  // namespace imgmesh::python
