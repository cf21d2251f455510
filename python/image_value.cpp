#include "python/image_value.h"

#include <algorithm>
#include <cmath>

#include "formats/picture/sample_codes.h"
#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/image/feature_space.h"
#include "python/views.h"
#include "python/work.h"

namespace imgmesh::python {
namespace {

namespace py = pybind11;

// numpy's float16, whose numbers C++20 has no type for.
constexpr char kFloat[] = "float32", kHalf[] = "float16";

[[noreturn]] void refuse(const std::string& name, const std::string& text) {
    throw Error(ErrorKind::kBadArgument, cat(name, ": ", text));
}

SampleType sample_type(const py::dtype& dtype, const std::string& name) {
    const auto size = dtype.itemsize();
    if (dtype.kind() == 'u' && size == 1) return SampleType::kUint8;
    if (dtype.kind() == 'u' && size == 2) return SampleType::kUint16;
    if (dtype.kind() == 'f' && size == 2) return SampleType::kHalf;
    if (dtype.kind() == 'f' && (size == 4 || size == 8)) return SampleType::kFloat;
    refuse(name, cat("the array is of ", std::string(py::str(py::object(dtype))),
                     ", expected uint8, uint16, float16, float32 or float64"));
}

std::string shape_text(const py::array& array) {
    return py::str(array.attr("shape"));
}

// Returns the array without gaps in the machine's own order of bytes; itself if it is like that.
py::array plain(const py::array& array, const char* type) {
    return py::module_::import("numpy").attr("ascontiguousarray")(array, type);
}

template <typename Code>
void fill(Image& image, const py::array& array, const char* type, bool values) {
    const py::array codes = plain(array, type);
    const auto* from = static_cast<const Code*>(codes.data());
    const auto alpha = static_cast<std::size_t>(image.channel("A"));  // none is no index
    without_gil({}, [&] {
        image.data.resize(image.sample_count());
        if constexpr (std::is_same_v<Code, float>) {
            std::copy_n(from, image.sample_count(), image.data.begin());
        } else {
            floats_from_codes(std::span(from, image.sample_count()), image.data);
            if (!values) return;
            const auto channels = static_cast<std::size_t>(image.channels);
            for (std::size_t i = 0; i < image.data.size(); ++i)
                if (i % channels != alpha) image.data[i] = from[i];
        }
    });
}

void check_finite(const Image& image, const std::string& name) {
    const auto found = std::ranges::find_if(image.data, [](float sample) { return !std::isfinite(sample); });
    if (found == image.data.end()) return;
    const auto at = static_cast<std::size_t>(found - image.data.begin());
    const auto channels = static_cast<std::size_t>(image.channels);
    throw Error(ErrorKind::kBadFile,
                cat(name, ": channel ", image.channel_names[at % channels], " of pixel (",
                    image.x_of(at / channels), ", ", image.y_of(at / channels), ") is not a finite number"));
}

// Refuses names that no file can hold, as reading a container does, and those that mean two channels.
void check_names(const std::vector<std::string>& names, const std::string& name) {
    constexpr std::size_t kMaxName = 255;  // of a channel of an EXR
    for (const std::string& channel : names) {
        if (channel.empty() || channel.size() > kMaxName)
            refuse(name,
                   cat("a name in channel_names has ", channel.size(), " bytes, expected 1 to ", kMaxName));
        if (channel.find('\0') != std::string::npos)
            refuse(name, "a name in channel_names holds a byte of value 0");
        if (std::ranges::count(names, channel) > 1) refuse(name, cat("two channels have the name ", channel));
    }
}

// What is in memory already is only held to a limit that was asked for, which take_read_options() tells by
// this 0.
void check_pixels(std::int64_t width, std::int64_t height, const ImageLimits& limits,
                  const std::string& name) {
    if (limits.max_pixels_per_byte == 0 && width * height > limits.max_pixels)
        refuse(name, cat("the image has ", width, "x", height,
                         " pixels, more than max_pixels=", limits.max_pixels));
}

// Returns an image without samples that has the array's shape.
Image shaped(const py::array& array, const ArrayMeaning& meaning, const std::string& name) {
    if (array.ndim() != 2 && array.ndim() != 3)
        refuse(name, cat("the array has the shape ", shape_text(array),
                         ", expected (height, width) or (height, width, channels)"));
    const ImageLimits limits;
    const py::ssize_t height = array.shape(0), width = array.shape(1),
                      channels = array.ndim() == 3 ? array.shape(2) : 1;
    if (height < 1 || width < 1 || channels < 1)
        refuse(name, cat("the array has the shape ", shape_text(array), ", which has no samples"));
    if (std::max(height, width) > limits.max_side || height * width > limits.max_pixels)
        refuse(name, cat("the array has the shape ", shape_text(array), ", more than ", limits.max_side,
                         " a side or ", limits.max_pixels, " pixels in all"));
    const auto named = static_cast<py::ssize_t>(meaning.channel_names.size());
    if (channels > limits.max_channels || (named == 0 && channels > 4))
        refuse(name, cat("the array has ", channels, " channels, expected 1 to 4, or up to ",
                         limits.max_channels, " in an Image with channel_names"));
    if (named != 0 && named != channels)
        refuse(name, cat("the array has ", channels, " channels, and channel_names has ", named, " names"));
    Image image = make_image(0, 0, static_cast<int>(channels));
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    check_names(meaning.channel_names, name);
    if (named > 0) image.channel_names = meaning.channel_names;
    return image;
}

}  // namespace

py::array array_of_object(const py::object& object, const std::string& name) {
    const py::object numpy = py::module_::import("numpy");
    if (py::isinstance(object, numpy.attr("ma").attr("MaskedArray")))
        refuse(name, "the array is masked; expected its data, and the pixels inside as mask=~array.mask");
    if (py::hasattr(object, "mode") && py::hasattr(object, "getbands")) {
        const std::string mode = py::str(object.attr("mode"));
        if (mode != "L" && mode != "LA" && mode != "RGB" && mode != "RGBA" && mode != "F" &&
            !mode.starts_with("I;16"))
            refuse(name, cat("the Pillow image is of the mode ", mode,
                             ", expected L, LA, RGB, RGBA, I;16 or F: image.convert('RGB') makes it one"));
    }
    return numpy.attr("asarray")(object);
}

ImagePointer image_from_array(const py::array& array, const ArrayMeaning& meaning, const std::string& name) {
    const auto value = std::make_shared<ImageValue>();
    const SampleType type = sample_type(array.dtype(), name);
    value->image = shaped(array, meaning, name);
    value->values = meaning.values;
    Image& image = value->image;
    const bool codes = type == SampleType::kUint8 || type == SampleType::kUint16;
    image.sample_type = codes && meaning.values ? SampleType::kFloat : type;
    image.color_space =
        meaning.color_space.value_or(codes && !meaning.values ? ColorSpace::kSrgb : ColorSpace::kLinear);
    if (type == SampleType::kUint8)
        fill<std::uint8_t>(image, array, "uint8", meaning.values);
    else if (type == SampleType::kUint16)
        fill<std::uint16_t>(image, array, "uint16", meaning.values);
    else
        fill<float>(image, array, kFloat, meaning.values);
    check_finite(image, name);
    if (meaning.values)
        for (std::string& channel : image.channel_names) channel = value_name(channel);
    return value;
}

ImagePointer image_from(const py::object& object, const ReadImageOptions& options, const std::string& name,
                        std::vector<std::string>& warnings) {
    if (py::isinstance<ImageValue>(object)) {
        const auto value = object.cast<std::shared_ptr<ImageValue>>();
        if (options.values && !value->values)
            refuse(name, "the Image holds colours; values=True where it is read or made makes them data");
        check_pixels(value->image.width, value->image.height, options.limits, name);
        return value;
    }
    if (!is_path(object)) {
        const py::array array = array_of_object(object, name);
        if (array.ndim() >= 2) check_pixels(array.shape(1), array.shape(0), options.limits, name);
        return image_from_array(array, {options.color_space, {}, options.values}, name);
    }
    const std::string path = path_text(object);
    ReadImage read = without_gil({}, [&] { return read_image_file(path, options); });
    for (const std::string& warning : read.warnings) warnings.push_back(cat(path, ": ", warning));
    return std::make_shared<ImageValue>(
        ImageValue{std::move(read.image), std::move(read.metadata), std::move(read.data), options.values});
}

py::array array_from(const Image& image) {
    std::vector<py::ssize_t> shape{image.height, image.width};
    if (image.channels > 1) shape.push_back(image.channels);
    if (image.sample_type == SampleType::kUint8)
        return array_of(without_gil({}, [&] { return codes8_from_floats(image.data); }), shape);
    if (image.sample_type == SampleType::kUint16)
        return array_of(without_gil({}, [&] { return codes16_from_floats(image.data); }), shape);
    const py::array floats = array_of(image.data, shape);
    return image.sample_type == SampleType::kHalf ? py::array(floats.attr("astype")(kHalf)) : floats;
}

bool is_path(const py::object& object) {
    return py::isinstance<py::str>(object) || py::isinstance<py::bytes>(object) ||
           py::hasattr(object, "__fspath__");
}

std::string path_text(const py::object& path) {
    const std::string text = py::bytes(py::module_::import("os").attr("fsencode")(path));
    if (text.find('\0') != std::string::npos)
        throw Error(ErrorKind::kBadArgument,
                    cat("the path ", std::string(py::repr(path)), " holds a byte of value 0"));
    return text;
}

}  // namespace imgmesh::python
