// reconstruct(): drawings of a mesh.
#include <pybind11/stl.h>

#include "libcore/image/feature_space.h"
#include "libcore/recon/draw_channels.h"
#include "python/bind.h"
#include "python/image_value.h"
#include "python/mesh_value.h"
#include "python/words.h"
#include "python/work.h"

namespace imgmesh::python {
namespace {

std::shared_ptr<ImageValue> reconstruct(const MeshValue& mesh, const std::string& mode, double scale,
                                        int level, bool all_channels, const std::optional<int>& threads) {
    check_level(mesh, level);
    const DrawParams params{parse_choice("mode", mode, draw_mode_choices()), scale};
    const MeshImage& mesh_image = mesh.mesh_image();
    const bool whole = params.mode == DrawMode::kMap || params.mode == DrawMode::kGouraud;
    const SplitNames names = split_names(mesh_image.source.channel_names);
    const bool channels = whole && (names.color.empty() || (all_channels && !names.auxiliary.empty()));
    checked_scale(mesh_image.source, params);
    return without_gil(threads, [&] {
        return std::make_shared<ImageValue>(
            ImageValue{channels ? draw_channels(mesh_image, level, params) : draw(mesh_image, level, params),
                       whole ? mesh.container.metadata : ExrMetadata(),
                       {},
                       names.color.empty()});
    });
}

std::string svg(const MeshValue& mesh, const std::string& mode, int level) {
    check_level(mesh, level);
    return draw_svg(mesh.mesh_image(), level, parse_choice("mode", mode, draw_mode_choices()));
}

constexpr char kReconstruct[] =
    R"(reconstruct(mode='map', scale=1, level=0, *, all_channels=False, threads=None) -> Image

Draws a level, in the dtype and colour space of the source.

mode          map, the reconstruction through the pixel map; gouraud; wire; patches; flat; visits
scale         size relative to the source's, for gouraud, wire and flat
level         of the pyramid, 0 the finest
all_channels  also the channels beside colour and alpha, in the modes map and gouraud; always of a mesh of values

Raises ArgumentError for a level that does not exist or a scale that the mode does not allow, UnsupportedError
for visits of a mesh without them.)";

}  // namespace

void bind_draw(py::module_& module) {
    auto mesh = py::reinterpret_borrow<py::class_<MeshValue, MeshPointer>>(module.attr("Mesh"));
    mesh.def("reconstruct", reconstruct, py::arg("mode") = "map", py::arg("scale") = 1.0,
             py::arg("level") = 0, py::kw_only(), py::arg("all_channels") = false,
             py::arg("threads") = py::none(), kReconstruct)
        .def("svg", svg, py::arg("mode") = "wire", py::arg("level") = 0,
             "svg(mode='wire', level=0) -> str\n\nReturns a drawing, wire or flat, as an SVG document.");
}

}  // namespace imgmesh::python
