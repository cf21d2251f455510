// imgmesh.Mesh, imgmesh.Level and read(): containers as objects whose arrays are views of their memory.
#include <pybind11/stl.h>

#include "formats/container/container.h"
#include "formats/export/mesh_arrays.h"
#include "libcore/base/error.h"
#include "libcore/mesh/outer_edge.h"
#include "python/bind.h"
#include "python/image_value.h"
#include "python/mesh_value.h"
#include "python/metadata.h"
#include "python/views.h"
#include "python/words.h"
#include "python/work.h"

namespace imgmesh::python {

void check_level(const MeshValue& mesh, int level) {
    const auto levels = static_cast<int>(mesh.mesh_image().levels.size());
    if (level < 0 || level >= levels)
        throw Error(ErrorKind::kBadArgument,
                    cat("level is ", level, ", the mesh has levels 0 to ", levels - 1));
}

namespace {

const LevelValue& level_of(const py::object& self) {
    return *self.cast<std::shared_ptr<LevelValue>>();
}

py::array vertices(const py::object& self) {
    const BaseMesh& mesh = level_of(self).level().mesh;
    const auto count = static_cast<py::ssize_t>(mesh.vertex_count());
    static_assert(sizeof(Vec2f) == 2 * sizeof(float));
    return view(self, {count, 2}, count == 0 ? nullptr : mesh.position[0].data());
}

py::array faces(const py::object& self) {
    const BaseMesh& mesh = level_of(self).level().mesh;
    static_assert(sizeof(Face) == 3 * sizeof(Id));
    return view(self, {static_cast<py::ssize_t>(mesh.faces.size()), 3},
                mesh.faces.empty() ? nullptr : mesh.faces[0].data());
}

py::array features(const py::object& self) {
    const BaseMesh& mesh = level_of(self).level().mesh;
    return view(self, {static_cast<py::ssize_t>(mesh.vertex_count()), mesh.channels}, mesh.feature.data());
}

py::object colors(const py::object& self) {
    const LevelValue& value = level_of(self);
    std::vector<float> rgb = vertex_colors(value.level().mesh, value.mesh->mesh_image().source);
    if (rgb.empty()) return py::none();
    const auto count = static_cast<py::ssize_t>(rgb.size() / 3);
    return array_of(std::move(rgb), {count, 3});
}

py::array face_ids(const py::object& self) {
    const PixelMap& map = level_of(self).level().map;
    constexpr py::ssize_t kStep = sizeof(PixelCoord);
    return view(self, {map.height, map.width}, {kStep * map.width, kStep}, &map.values.data()->face);
}

py::array barycentrics(const py::object& self) {
    const PixelMap& map = level_of(self).level().map;
    constexpr py::ssize_t kStep = sizeof(PixelCoord),
                          kNext = offsetof(PixelCoord, v) - offsetof(PixelCoord, u);
    return view(self, {map.height, map.width, 2}, {kStep * map.width, kStep, kNext}, &map.values.data()->u);
}

py::array mask(const py::object& self) {
    return face_ids(self).attr("__ne__")(kNone);
}

MeshPointer mesh_of(const py::object& self) {
    return self.cast<MeshPointer>();
}

py::tuple levels(const py::object& self) {
    const MeshPointer mesh = mesh_of(self);
    py::tuple all(mesh->mesh_image().levels.size());
    for (std::size_t k = 0; k < mesh->mesh_image().levels.size(); ++k)
        all[k] = py::cast(std::make_shared<LevelValue>(LevelValue{mesh, k}));
    return all;
}

// A property of the finest level.
template <typename Property>
auto of_finest(Property property) {
    return [property](const py::object& self) {
        return property(py::cast(std::make_shared<LevelValue>(LevelValue{mesh_of(self), 0})));
    };
}

py::object visits(const py::object& self) {
    const MeshPointer mesh = mesh_of(self);
    const MeshImage& mesh_image = mesh->mesh_image();
    if (mesh_image.visits.empty()) return py::none();
    return view(self, {mesh_image.source.height, mesh_image.source.width}, mesh_image.visits.data());
}

py::dict parameters(const MeshValue& mesh) {
    py::dict dict;
    for (const auto& [name, value] : mesh.mesh_image().parameters) dict[py::str(name)] = py::cast(value);
    return dict;
}

py::object report(const MeshValue& mesh) {
    if (!mesh.report) return py::none();
    const BuildReport& r = *mesh.report;
    const std::vector<std::string> names = split_names(mesh.mesh_image().source.channel_names).auxiliary;
    py::list levels;
    for (const LevelReport& level : r.levels) {
        py::dict channels;
        for (std::size_t c = 0; c < level.auxiliary_rms.size(); ++c)
            channels[py::str(names.at(c))] = level.auxiliary_rms[c];
        levels.append(py::dict(
            py::arg("map_rms") = level.map_rms, py::arg("gouraud_rms") = level.gouraud_rms,
            py::arg("channel_rms") = channels, py::arg("position_step") = level.position_step,
            py::arg("fine_vertices") = level.fine_vertices, py::arg("color_levels") = level.color_levels));
    }
    return py::dict(
        py::arg("pixels") = r.pixels, py::arg("clipped_samples") = r.clipped_samples,
        py::arg("collapses") = r.collapses, py::arg("levels") = levels, py::arg("missed") = mesh.missed,
        py::arg("seconds") = py::dict(py::arg("collapse") = r.seconds.collapse,
                                      py::arg("refine") = r.seconds.refine, py::arg("map") = r.seconds.map));
}

py::list file_names(const std::vector<std::string>& files) {
    py::list names;
    for (const std::string& file : files)
        names.append(py::module_::import("os").attr("fsdecode")(py::bytes(file)));
    return names;
}

py::object facts(const MeshValue& mesh) {
    const ContainerFacts& f = mesh.container.facts;
    if (f.files.empty()) return py::none();
    return py::dict(py::arg("version") = f.version, py::arg("draco") = name_of(draco_choices(), f.draco),
                    py::arg("layers") = name_of(layer_choices(), f.layout),
                    py::arg("files") = file_names(f.files), py::arg("total_bytes") = f.total_bytes,
                    py::arg("mesh_bytes") = f.mesh_bytes, py::arg("layer_bytes") = f.layer_bytes,
                    py::arg("texture_bytes") = f.texture_bytes);
}

MeshPointer read(const py::object& path, const std::optional<int>& threads) {
    const std::string name = path_text(path);
    return without_gil(threads, [&] { return std::make_shared<MeshValue>(MeshValue{read_container(name)}); });
}

py::dict write(const MeshValue& mesh, const py::object& path, const std::optional<std::string>& draco,
               const std::optional<std::string>& layers, bool no_map, bool overwrite,
               const std::optional<int>& threads) {
    ContainerOptions options;
    options.draco = word_value("draco", draco, draco_choices())
                        .value_or(no_map ? DracoMode::kOff : mesh.container.facts.draco);
    const std::optional<LayerLayout> layout = word_value("layers", layers, layer_choices());
    if (no_map && layout) throw Error(ErrorKind::kBadArgument, "layers and no_map: there are no layers then");
    options.layers = no_map ? LayerLayout::kOff : layout.value_or(mesh.container.facts.layout);
    options.overwrite = overwrite;
    options.metadata = mesh.container.metadata;
    options.texture = mesh.container.texture;
    const std::string name = path_text(path);
    const WrittenContainer written = without_gil(threads, [&] {
        if (!no_map || !options.texture.picture.empty())
            return write_container(name, mesh.mesh_image(), options);
        MeshImage plain = mesh.mesh_image();
        cover_whole_pixels(plain);
        return write_container(name, plain, options);
    });
    return py::dict(py::arg("files") = file_names(written.files), py::arg("mesh_bytes") = written.mesh_bytes,
                    py::arg("layer_bytes") = written.layer_bytes);
}

constexpr char kMesh[] = R"(An image as small triangle meshes, each with a pixel map: what a container holds.

build() and read() return one. It never changes. Its arrays are read-only views of its memory and keep it alive.
Those of the finest level are here as well as in levels[0].)";

constexpr char kLevel[] = R"(One mesh of a pyramid, with its pixel map; level 0 is the finest.

Positions are in pixels: (0, 0) is the centre of the top left pixel, x grows to the right, y down.)";

constexpr char kRead[] = R"(read(path, *, threads=None) -> Mesh

Reads a container (.glb, .gltf) and checks all of it.

Raises FileError if a file cannot be read, BadFileError for a file that is no sound container, UnsupportedError
for one of a newer version.)";

constexpr char kWrite[] =
    R"(write(path, *, draco=None, layers=None, no_map=False, overwrite=True, threads=None) -> dict

Writes the container and returns its files, mesh_bytes and layer_bytes, as facts of a mesh that is read has them; the name's extension (.glb, .gltf) decides the kind. The bytes are those that imgmesh-build
writes with the same parameters. Draco chooses an order of vertices and faces of its own, so that numbers of
vertices and faces change unless draco is 'none'.

draco   edgebreaker, sequential or none; None: as the mesh was read, or edgebreaker; with no_map none
layers  exr or compact, a sixth of the bytes, for maps on a grid; None: as the mesh was read, or as imgmesh-build
no_map  write the meshes alone, without pixel maps: a plain glTF asset for engines that imgmesh cannot read,
        as imgmesh-convert --no-map does

Raises ArgumentError for another extension, FileError if a file cannot be written, or exists and overwrite is
False.)";

template <typename Class>
void bind_arrays(Class& bound, const auto& of) {
    bound
        .def_property_readonly("vertices", of(vertices),
                               "Positions of the V vertices, V x 2 of float32, in pixels.")
        .def_property_readonly(
            "faces", of(faces),
            "Vertices of the F faces, F x 3 of uint32, counter-clockwise as seen on screen.")
        .def_property_readonly(
            "features", of(features),
            "Colours as L*u*v* (L* from 0 to 100) and after them other channels in their own "
            "unit, V x channels of float32.")
        .def_property_readonly(
            "colors", of(colors),
            "Colours of the vertices as sRGB from 0 to 1, of an HDR image as linear RGB: V x 3 "
            "of float32, computed anew. None for a mesh without colour.")
        .def_property_readonly("face_ids", of(face_ids),
                               "The face of every pixel, height x width of uint32; NO_FACE outside the mask.")
        .def_property_readonly(
            "barycentrics", of(barycentrics),
            "The weights u, v of the second and third corner of every pixel's face, height x "
            "width x 2 of float32; that of the first is 1 - u - v.")
        .def_property_readonly("mask", of(mask),
                               "The pixels that have a face, height x width of bool, computed anew.");
}

}  // namespace

void bind_container(py::module_& module) {
    module.attr("NO_FACE") = kNone;
    py::class_<LevelValue, std::shared_ptr<LevelValue>> level(module, "Level", py::is_final(), kLevel);
    refuse_new(level);
    bind_arrays(level, [](auto property) { return property; });
    level
        .def_property_readonly(
            "index", [](const LevelValue& l) { return l.index; }, "0 for the finest level.")
        .def_property_readonly(
            "error", [](const LevelValue& l) { return l.level().error; },
            "The largest quadric error that a collapse down to here has had.")
        .def("__repr__", [](const LevelValue& l) {
            return cat("<imgmesh.Level ", l.index, ": ", l.level().mesh.vertex_count(), " vertices, ",
                       l.level().mesh.faces.size(), " faces>");
        });

    py::class_<MeshValue, MeshPointer> mesh(module, "Mesh", py::is_final(), kMesh);
    refuse_new(mesh);
    bind_arrays(mesh, [](auto property) { return of_finest(property); });
    const auto source = [](const auto& get) {
        return [get](const MeshValue& m) { return get(m.mesh_image().source); };
    };
    mesh.def_property_readonly("levels", levels, "The levels, finest first, as a tuple of Level.")
        .def_property_readonly("width", source([](const SourceInfo& s) { return s.width; }),
                               "Of the image, in pixels.")
        .def_property_readonly("height", source([](const SourceInfo& s) { return s.height; }),
                               "Of the image, in pixels.")
        .def_property_readonly(
            "channel_names", source([](const SourceInfo& s) { return py::tuple(py::cast(s.channel_names)); }),
            "The channels that the meshes are made of, by their names in the file.")
        .def_property_readonly("color_space", source([](const SourceInfo& s) {
                                   return std::string(color_space_name(s.color_space));
                               }),
                               "Of the image, such as 'sRGB'.")
        .def_property_readonly("dtype", source([](const SourceInfo& s) {
                                   return py::dtype(name_of(dtype_names(), s.sample_type));
                               }),
                               "Of the image's samples.")
        .def_property_readonly("has_mask", source([](const SourceInfo& s) { return s.has_mask; }),
                               "Whether some pixels have no face.")
        .def_property_readonly("is_hdr", source([](const SourceInfo& s) { return s.gamut == Gamut::kHdr; }),
                               "Whether colours may be brighter than white.")
        .def_property_readonly(
            "visits", visits,
            "How often the collapse touched each pixel, height x width of uint32; None unless "
            "built with visits=True.")
        .def_property_readonly("parameters", parameters,
                               "What shaped the meshes, by the names of the tools' options.")
        .def_property_readonly(
            "metadata", [](const MeshValue& m) { return metadata_dict(m.container.metadata); },
            "Attributes of the EXR that the image came from.")
        .def_property_readonly(
            "generator", [](const MeshValue& m) { return m.mesh_image().generator; },
            "The program and version that made the container.")
        .def_property_readonly(
            "report", report,
            "Figures of the build: errors of each level (RMS in L*u*v*, or in the values' unit), "
            "seconds of each stage. None for a mesh that was read.")
        .def_property_readonly("facts", facts,
                               "The files of the container and their bytes. None for a mesh that was built.")
        .def("write", write, py::arg("path"), py::kw_only(), py::arg("draco") = py::none(),
             py::arg("layers") = py::none(), py::arg("no_map") = false, py::arg("overwrite") = true,
             py::arg("threads") = py::none(), kWrite)
        .def("__repr__", [](const MeshValue& m) {
            const Level& finest = m.mesh_image().levels.front();
            return cat("<imgmesh.Mesh of ", m.mesh_image().source.width, "x", m.mesh_image().source.height,
                       " pixels: ", finest.mesh.vertex_count(), " vertices, ", finest.mesh.faces.size(),
                       " faces, ", m.mesh_image().levels.size(),
                       m.mesh_image().levels.size() == 1 ? " level>" : " levels>");
        });
    module.def("read", read, py::arg("path"), py::kw_only(), py::arg("threads") = py::none(), kRead);
}

}  // namespace imgmesh::python
