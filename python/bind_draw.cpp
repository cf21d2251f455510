// reconstruct(), svg() and smooth(): drawings of a mesh.
#include <pybind11/stl.h>

#include "libcore/base/error.h"
#include "libcore/image/color.h"
#include "libcore/image/feature_space.h"
#include "libcore/recon/draw_channels.h"
#include "libcore/segment/segment.h"
#include "libcore/segment/smooth_image.h"
#include "python/bind.h"
#include "python/errors.h"
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

std::shared_ptr<ImageValue> smooth(const MeshValue& mesh, double strength, const py::object& image, int level,
                                   const py::object& callback, const std::optional<int>& threads) {
    check_level(mesh, level);
    const MeshImage& mesh_image = mesh.mesh_image();
    if (split_names(mesh_image.source.channel_names).color.empty())
        throw Error(ErrorKind::kUnsupported, "the mesh has no colour");
    std::vector<std::string> warnings;
    ReadImageOptions colors;
    colors.channels.emplace();  // the colour and alpha
    const ImagePointer own = image.is_none() ? nullptr : image_from(image, colors, "image", warnings);
    const Progress progress = python_progress(callback);
    const std::shared_ptr<ImageValue> value = without_gil(threads, [&] {
        const Level& drawn = mesh_image.levels[static_cast<std::size_t>(level)];
        const imgmesh::Range range =
            mesh_image.source.gamut == Gamut::kHdr ? imgmesh::Range::kHdr : imgmesh::Range::kClipped;
        Image result = own ? smooth_image(drawn, luv_image(own->image, range), own->image, strength, progress)
                           : smooth_image(drawn, reconstruct_luv(drawn), draw(mesh_image, level, {}),
                                          strength, progress);
        return std::make_shared<ImageValue>(ImageValue{std::move(result), mesh.container.metadata});
    });
    warn(warnings);
    return value;
}

constexpr char kSmooth[] =
    R"(smooth(strength=8, *, image=None, level=0, progress=None, threads=None) -> Image

Smooths inside the regions of a level's segmentation and keeps their borders, as imgmesh-reconstruct --mode smooth does.

strength  contours and differences weaker than this vanish, in L*u*v*
image     the image itself, to smooth instead of the reconstruction: a path, an Image or an array
level     of the pyramid, 0 the finest
progress  called with the fraction done and the name of the stage

Raises ArgumentError for a strength out of range, a level that does not exist and an image of another size.)";

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
        .def("smooth", smooth, py::arg("strength") = kUsualStrength, py::kw_only(),
             py::arg("image") = py::none(), py::arg("level") = 0, py::arg("progress") = py::none(),
             py::arg("threads") = py::none(), kSmooth)
        .def("svg", svg, py::arg("mode") = "wire", py::arg("level") = 0,
             "svg(mode='wire', level=0) -> str\n\nReturns a drawing, wire or flat, as an SVG document.");
}

}  // namespace imgmesh::python
