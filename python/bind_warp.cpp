// warp(), warp_mesh() and displacement(): edits of a mesh's image.
#include <pybind11/stl.h>

#include "formats/container/edit_file.h"
#include "libcore/base/error.h"
#include "libcore/warp/retarget.h"
#include "libcore/warp/solve_edits.h"
#include "libcore/warp/warp_image.h"
#include "libcore/warp/warp_maps.h"
#include "libcore/warp/warp_mesh.h"
#include "python/bind.h"
#include "python/errors.h"
#include "python/image_value.h"
#include "python/mesh_value.h"
#include "python/views.h"
#include "python/work.h"

namespace imgmesh::python {
namespace {

// As imgmesh-build's (docs/decisions/0031-python.md).
constexpr char kGenerator[] = "imgmesh-warp " IMGMESH_VERSION;

// What JSON makes of a value that it has none for: numpy's numbers and arrays as Python's.
py::object plain_value(const py::object& value) {
    if (py::hasattr(value, "tolist")) return value.attr("tolist")();
    throw py::type_error(
        cat("edits: expected numbers, words, lists and dicts, found ", std::string(py::repr(value))));
}

std::string json_text(const py::object& document) {
    try {
        return py::str(py::module_::import("json").attr("dumps")(
            document, py::arg("default") = py::cpp_function(plain_value)));
    } catch (const py::error_already_set& e) {
        if (e.matches(PyExc_RecursionError))
            throw Error(ErrorKind::kBadArgument, "edits: lists and dicts within each other are too deep");
        if (e.matches(PyExc_ValueError))
            throw Error(ErrorKind::kBadArgument, "edits: a list or dict holds itself");
        throw;
    }
}

// A path of a file of edits, or what such a file holds: a list of edits or the whole object.
WarpEdits edits_from(const py::object& edits) {
    if (edits.is_none()) return {};
    if (is_path(edits)) return read_edits(path_text(edits));
    py::object document = edits;
    if (!py::isinstance<py::dict>(edits)) document = py::dict(py::arg("edits") = py::list(edits));
    return edits_from_json(json_text(document), "edits");
}

OutputSize size_of(const std::optional<std::pair<int, int>>& size) {
    if (!size) return {};
    if (size->first < 1 || size->second < 1)
        throw Error(ErrorKind::kBadArgument, cat("the size is ", size->first, "x", size->second,
                                                 ", expected a width and a height of at least 1"));
    return {size->first, size->second};
}

using Size = std::optional<std::pair<int, int>>;

// Solves the edits, and tells in `warnings` which handles are not where they should be.
EditSolution solve(const MeshImage& mesh_image, const WarpEdits& edits, std::vector<std::string>& warnings) {
    EditSolution solution = edit_solution(mesh_image, edits);
    warnings = missed_places(solution);
    for (std::string& text : warnings) text = "edits: " + text;
    return solution;
}

DisplacementField field_of(const MeshImage& mesh_image, const WarpEdits& edits, const Size& retarget,
                           std::vector<std::string>& warnings) {
    DisplacementField field = edit_field(mesh_image, solve(mesh_image, edits, warnings));
    if (retarget) add_field(field, retarget_field(mesh_image, size_of(retarget)));
    return field;
}

OutputSize drawn_size(const Size& size, const Size& retarget) {
    if (size && retarget) throw Error(ErrorKind::kBadArgument, "size and retarget: expected one of them");
    return size_of(size ? size : retarget);
}

ImagePointer source_image(const py::object& object, const MeshImage& mesh_image) {
    std::vector<std::string> warnings;
    ImagePointer image = image_from(object, {}, "image", warnings);
    const SourceInfo& source = mesh_image.source;
    if (image->image.width != source.width || image->image.height != source.height)
        throw Error(ErrorKind::kBadFile, cat("the image has ", image->image.width, "x", image->image.height,
                                             " pixels, that of the mesh ", source.width, "x", source.height));
    warn(warnings);
    return image;
}

std::shared_ptr<ImageValue> warp(const MeshValue& mesh, const py::object& image, const py::object& edits,
                                 const Size& size, const Size& retarget, const std::optional<int>& threads) {
    const OutputSize drawn = drawn_size(size, retarget);
    const WarpEdits all = edits_from(edits);
    const MeshImage& mesh_image = mesh.mesh_image();
    const ImagePointer source = source_image(image, mesh_image);
    std::vector<std::string> warnings;
    const auto drawing = without_gil(threads, [&] {
        return std::make_shared<ImageValue>(
            ImageValue{warp_image(source->image, field_of(mesh_image, all, retarget, warnings), drawn),
                       mesh.container.metadata});
    });
    warn(warnings);
    return drawing;
}

MeshPointer warp_mesh(const MeshValue& mesh, const py::object& edits, const std::optional<int>& threads) {
    const WarpEdits all = edits_from(edits);
    std::vector<std::string> warnings;
    const MeshPointer result = without_gil(threads, [&] {
        const auto warped = std::make_shared<MeshValue>(MeshValue{mesh.container});
        const std::vector<VertexMoves> moves = solve(mesh.mesh_image(), all, warnings).moves;
        MeshImage& mesh_image = warped->container.mesh_image;
        mesh_image = warp_mesh_image(std::move(mesh_image), moves);
        mesh_image.generator = kGenerator;
        warped->container.facts = {};
        warped->container.facts.draco = mesh.container.facts.draco;
        return warped;
    });
    warn(warnings);
    return result;
}

py::array displacement(const MeshValue& mesh, const py::object& edits, const std::optional<int>& threads) {
    const WarpEdits all = edits_from(edits);
    std::vector<std::string> warnings;
    Image map = without_gil(
        threads, [&] { return forward_map_image(field_of(mesh.mesh_image(), all, {}, warnings)); });
    warn(warnings);
    const py::ssize_t height = map.height, width = map.width;
    return array_of(std::move(map.data), {height, width, 2});
}

py::array st_map(const MeshValue& mesh, const py::object& edits, const py::object& image, const Size& size,
                 const Size& retarget, const std::optional<int>& threads) {
    const OutputSize drawn = drawn_size(size, retarget);
    const WarpEdits all = edits_from(edits);
    const MeshImage& mesh_image = mesh.mesh_image();
    const ImagePointer source = image.is_none() ? nullptr : source_image(image, mesh_image);
    std::vector<std::string> warnings;
    Image map = without_gil(threads, [&] {
        const InverseMap inverse =
            inverse_map(field_of(mesh_image, all, retarget, warnings),
                        source ? alpha_of(source->image) : std::vector<float>(), drawn);
        return st_map_image(inverse, mesh_image.source.width, mesh_image.source.height);
    });
    warn(warnings);
    const py::ssize_t height = map.height, width = map.width, channels = map.channels;
    return array_of(std::move(map.data), {height, width, channels});
}

constexpr char kWarp[] = R"(warp(image, edits=None, *, size=None, retarget=None, threads=None) -> Image

Draws the image with its pixels moved as the edits move the vertices of the meshes, as imgmesh-warp does.

image     the image that the mesh was made from: a path, an Image or an array
edits     a file of edits, or what it holds (docs/warp.md): a list of dicts such as
          {'level': 0, 'solver': 'arap', 'handles': [{'near': [40, 30], 'move': [10, 0]}], 'pins': [{'border': True}]}
size      (width, height) of the drawing; None: that of the image
retarget  (width, height): detail keeps its proportions and the rest of the image gives way

Raises BadFileError for edits that are not as they must be, an image of another size, and a vertex or level that
does not exist. Warns where a handle of an injective edit cannot get where it should.)";

}  // namespace

void bind_warp(py::module_& module) {
    auto mesh = py::reinterpret_borrow<py::class_<MeshValue, MeshPointer>>(module.attr("Mesh"));
    mesh.def("warp", warp, py::arg("image"), py::arg("edits") = py::none(), py::kw_only(),
             py::arg("size") = py::none(), py::arg("retarget") = py::none(), py::arg("threads") = py::none(),
             kWarp)
        .def("warp_mesh", warp_mesh, py::arg("edits"), py::kw_only(), py::arg("threads") = py::none(),
             "warp_mesh(edits, *, threads=None) -> Mesh\n\nReturns the mesh with its vertices moved by the "
             "edits of "
             "warp(). The pixel maps stay. Raises UnsupportedError where a face would turn over.")
        .def("displacement", displacement, py::arg("edits"), py::kw_only(), py::arg("threads") = py::none(),
             "displacement(edits, *, threads=None) -> array\n\nHow far the edits of warp() move each pixel "
             "to the "
             "right and down, height x width x 2 of float32, in pixels.")
        .def("st_map", st_map, py::arg("edits") = py::none(), py::kw_only(), py::arg("image") = py::none(),
             py::arg("size") = py::none(), py::arg("retarget") = py::none(), py::arg("threads") = py::none(),
             "st_map(edits=None, *, image=None, size=None, retarget=None, threads=None) -> array\n\nThe "
             "STMap of the "
             "drawing of warp(), height x width x 3 of float32: which place of the image each pixel shows, "
             "from 0 "
             "to 1 across it, upwards in the second channel, and the share of the pixel that is covered. The "
             "alpha "
             "of the image counts where one is given.");
}

}  // namespace imgmesh::python
