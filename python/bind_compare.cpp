// compare(): the differences of two images.
#include <pybind11/stl.h>

#include "formats/files/extension.h"
#include "libcore/base/error.h"
#include "libcore/image/mask.h"
#include "libcore/metrics/compare_channels.h"
#include "libcore/metrics/compare_images.h"
#include "libcore/recon/draw_channels.h"
#include "python/bind.h"
#include "python/errors.h"
#include "python/image_value.h"
#include "python/mesh_value.h"
#include "python/views.h"
#include "python/work.h"

namespace imgmesh::python {
namespace {

// imgmesh.Comparison.
struct ComparisonValue {
    ImageDifference difference;
    std::vector<ChannelDifference> channels;
    GridSize size;
};
using ComparisonPointer = std::shared_ptr<ComparisonValue>;

// An image, or the reconstruction of a mesh or container.
Image drawn(const py::object& object, const char* name, std::vector<std::string>& warnings) {
    MeshPointer mesh;
    if (py::isinstance<MeshValue>(object)) {
        mesh = object.cast<MeshPointer>();
    } else if (is_path(object)) {
        const std::string path = path_text(object), extension = lower_extension(path);
        if (extension == ".glb" || extension == ".gltf")
            mesh =
                without_gil({}, [&] { return std::make_shared<MeshValue>(MeshValue{read_container(path)}); });
    }
    if (mesh) return without_gil({}, [&] { return draw_channels(mesh->mesh_image(), 0, {}); });
    const ImagePointer image = image_from(object, {}, name, warnings);
    return hidden_outside(image->image, image->data);
}

ComparisonPointer compare(const py::object& a, const py::object& b, const std::optional<int>& threads) {
    std::vector<std::string> warnings;
    const Image first = drawn(a, "a", warnings), second = drawn(b, "b", warnings);
    const auto value = std::make_shared<ComparisonValue>();
    without_gil(threads, [&] {
        value->difference = compare_images(first, second);
        value->channels = compare_channels(first, second);
        value->size = first;
        return true;
    });
    warn(warnings);
    return value;
}

// A property that is an array of one value a pixel.
auto errors(std::vector<float> ImageDifference::*member) {
    return [member](const py::object& self) {
        const ComparisonPointer value = self.cast<ComparisonPointer>();
        return view(self, {value->size.height, value->size.width}, (value->difference.*member).data());
    };
}

template <typename Number>
auto figure(Number ImageDifference::*member) {
    return [member](const ComparisonValue& value) { return value.difference.*member; };
}

py::dict channels(const ComparisonValue& value) {
    py::dict all;
    for (const ChannelDifference& channel : value.channels)
        all[py::str(channel.name)] = py::dict(py::arg("rms") = channel.rms, py::arg("max") = channel.max);
    return all;
}

}  // namespace

void bind_compare(py::module_& module) {
    using D = ImageDifference;
    py::class_<ComparisonValue, ComparisonPointer> comparison(
        module, "Comparison", py::is_final(), "The differences of two images. Arrays are read-only views.");
    refuse_new(comparison);
    comparison
        .def_property_readonly("pixels", figure(&D::pixels),
                               "Pixels compared: not transparent in either image.")
        .def_property_readonly("in_one_only", figure(&D::in_one_only),
                               "Pixels transparent in one of the two.")
        .def_property_readonly("rms_luv", figure(&D::rms_luv), "Root mean square of the distances in L*u*v*.")
        .def_property_readonly("max_luv", figure(&D::max_luv), "Largest distance in L*u*v*.")
        .def_property_readonly("rms_visible", figure(&D::rms_visible),
                               "rms_luv of what one sees, over black or white, whichever differs more.")
        .def_property_readonly("max_visible", figure(&D::max_visible), "max_luv of what one sees.")
        .def_property_readonly("rms_alpha", figure(&D::rms_alpha), "Root mean square difference of alpha.")
        .def_property_readonly("max_alpha", figure(&D::max_alpha), "Largest difference of alpha.")
        .def_property_readonly("rms_rgb", figure(&D::rms_rgb),
                               "Root mean square difference of RGB from 0 to 1.")
        .def_property_readonly("max_rgb", figure(&D::max_rgb), "Largest difference of RGB from 0 to 1.")
        .def_property_readonly("psnr", figure(&D::psnr),
                               "20 log10(1 / rms_rgb), in dB; infinite for equal images.")
        .def_property_readonly("ssim", figure(&D::ssim),
                               "Structural similarity; NaN for images below 11 x 11.")
        .def_property_readonly(
            "luv", errors(&D::luv),
            "Distance in L*u*v* of every pixel, height x width of float32; NaN where not compared.")
        .def_property_readonly("ciede2000", errors(&D::ciede2000), "CIEDE2000 of every pixel, likewise.")
        .def_property_readonly("visible", errors(&D::visible), "The distances of rms_visible, likewise.")
        .def_property_readonly(
            "channels", channels,
            "rms and max of each channel that both have beside colour and alpha, by its name.")
        .def("__repr__", [](const ComparisonValue& v) {
            return cat("<imgmesh.Comparison of ", v.difference.pixels, " pixels: ", v.difference.psnr,
                       " dB, RMS ", v.difference.rms_luv, " L*u*v*>");
        });
    module.def("compare", compare, py::arg("a"), py::arg("b"), py::kw_only(), py::arg("threads") = py::none(),
               R"(compare(a, b, *, threads=None) -> Comparison

Compares two images of one size, as imgmesh-compare does. Each is a path, an Image, an array as Image takes it, a
Mesh, or the path of a container; of the last two the reconstruction is compared.

Raises ArgumentError if the sizes differ, UnsupportedError for an image without colour.)");
}

}  // namespace imgmesh::python
