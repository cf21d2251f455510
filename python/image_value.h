// Images between numpy and libcore.
#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/picture/image_io.h"
#include "libcore/image/image.h"

namespace imgmesh::python {

/// imgmesh.Image: an image, and what its file says beside the pixels. Never changes.
struct ImageValue {
    Image image;
    ExrMetadata metadata = {};
    Mask data = {};       ///< the pixels with data; empty() for all
    bool values = false;  ///< the samples are data and no colours
};
using ImagePointer = std::shared_ptr<const ImageValue>;

/// What the samples of an array mean, beside its dtype.
struct ArrayMeaning {
    std::optional<ColorSpace> color_space = {};   ///< none: sRGB for integers, linear for floats
    std::vector<std::string> channel_names = {};  ///< none: Y, YA, RGB or RGBA, by their number
    bool values = false;                          ///< as ReadImageOptions::values
};

/// Returns the array that numpy makes of an object. Throws Error(kBadArgument) where its numbers would not
/// mean what an array's do: of a Pillow image with a palette or inks, and of a masked array.
pybind11::array array_of_object(const pybind11::object& object, const std::string& name);

/// Converts an array to an image as reading a PNG (uint8, uint16) or an EXR (float16, float32, float64, alpha
/// not multiplied in) with these samples would. Copies once.
///
/// array   height x width, or height x width x channels
/// Throws Error(kBadArgument) for another dtype or shape or a name too few, Error(kBadFile) for samples that
/// are not finite; messages begin with `name`.
ImagePointer image_from_array(const pybind11::array& array, const ArrayMeaning& meaning,
                              const std::string& name);

/// Returns the image that `object` is: an imgmesh.Image, the path of a file, or whatever numpy makes an array
/// of. `warnings` get those of reading the file.
ImagePointer image_from(const pybind11::object& object, const ReadImageOptions& options,
                        const std::string& name, std::vector<std::string>& warnings);

/// Returns the samples of an image in the type that its file has, as a new array: codes of integers are
/// rounded and clamped, all else is float16 or float32. height x width for one channel.
pybind11::array array_from(const Image& image);

/// Whether `object` is a path: a str, bytes or os.PathLike.
bool is_path(const pybind11::object& object);
/// Returns the path as the file system has it. Throws as os.fsencode() does.
std::string path_text(const pybind11::object& path);

}  // namespace imgmesh::python
