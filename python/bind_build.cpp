// build(): an image in, a Mesh out. The same steps as those of imgmesh-build.
#include <pybind11/stl.h>

#include "formats/picture/texture_file.h"
#include "libcore/base/range.h"
#include "libcore/image/feature_space.h"
#include "libcore/mesh/outer_edge.h"
#include "libcore/pipeline/build_source.h"
#include "libcore/pipeline/lean_mesh.h"
#include "libcore/pipeline/targets.h"
#include "python/bind.h"
#include "python/build_arguments.h"
#include "python/errors.h"
#include "python/image_value.h"
#include "python/mesh_value.h"
#include "python/read_arguments.h"
#include "python/words.h"
#include "python/work.h"
#include "tools/common/in_file.h"

namespace imgmesh::python {
namespace {

// The program that builds containers. What a container says of its making is the same whoever called the
// libraries of this version (docs/decisions/0031-python.md).
constexpr char kGenerator[] = "imgmesh-build " IMGMESH_VERSION;

struct Request {
    std::string name;  ///< of the image in messages
    BuildParams params;
    AlphaParams alpha;
    ReadImageOptions read;
    std::optional<TextureType> texture;
    std::optional<int> threads;
    bool strict = false, density = false;  ///< whether density was asked for
    py::object mask, progress;
};

// Removes it from the arguments, and returns it as T.
template <typename T>
std::optional<T> take_as(py::dict& arguments, const char* name) {
    const py::object value = take(arguments, name);
    if (value.is_none()) return std::nullopt;
    try {
        return value.cast<T>();
    } catch (const py::cast_error&) {
        throw py::type_error(cat(name, ": found ", std::string(py::repr(value))));
    }
}

// What build() takes beside the parameters of the table.
constexpr const char* kOthers[] = {"preset", "mask",       "alpha",    "alpha_threshold", "texture",
                                   "strict", "threads",    "progress", "color_space",     "part",
                                   "layer",  "non_finite", "nodata",   "max_pixels"};

Request request_of(const py::object& source, py::dict arguments) {
    Request r;
    r.name = is_path(source) ? path_text(source) : "image";
    const bool values = arguments.contains("values") && py::bool_(arguments["values"]);
    r.density = arguments.contains("density") && !arguments["density"].is_none();
    r.params = take_build_params(arguments);
    r.read = take_read_options(arguments);
    r.read.values = values;
    r.mask = take(arguments, "mask");
    r.progress = take(arguments, "progress");
    r.threads = take_as<int>(arguments, "threads");
    r.strict = take_as<bool>(arguments, "strict").value_or(false);
    r.alpha.use = word_value("alpha", take_as<std::string>(arguments, "alpha"), alpha_choices())
                      .value_or(AlphaUse::kAuto);
    r.alpha.threshold = take_as<double>(arguments, "alpha_threshold");
    const NumberRange share{0, 1, true};
    if (r.alpha.threshold && !contains(share, *r.alpha.threshold))
        throw Error(ErrorKind::kBadArgument,
                    cat("alpha_threshold is ", *r.alpha.threshold, ", expected ", describe(share)));
    r.texture = word_value("texture", take_as<std::string>(arguments, "texture"), texture_type_choices());
    py::list known;
    for (const py::handle row : list_build_params()) known.append(row["name"]);
    for (const char* other : kOthers) known.append(other);
    refuse_others("build", arguments, known);
    if (values && r.alpha.use == AlphaUse::kKeep)
        throw Error(
            ErrorKind::kBadArgument,
            "values=True and alpha='keep': alpha is a mask beside values, or with channels one of them");
    if (values && (r.texture || r.read.color_space))
        throw Error(ErrorKind::kBadArgument, cat("values=True and ", r.texture ? "texture" : "color_space",
                                                 ": values are no colours"));
    return r;
}

// Refuses what reading a file with such channels does. With alpha alone a mesh of alpha would come of it.
void check_color(const Image& image, const std::string& name) {
    if (!split_names(image.channel_names).color.empty()) return;
    std::string names;
    for (const std::string& channel : image.channel_names) names += (names.empty() ? "" : ", ") + channel;
    throw Error(ErrorKind::kUnsupported,
                cat(name, ": the image has no colour, neither channels R, G, B nor Y, but ", names,
                    "; channels can be chosen"));
}

// A mask of bool is an image of 0 and 1.
ImagePointer mask_picture(const py::object& mask, const ImageLimits& limits,
                          std::vector<std::string>& warnings) {
    py::object picture = mask;
    if (py::isinstance<py::array>(mask) && py::array(mask).dtype().kind() == 'b')
        picture =
            mask.attr("astype")("uint8").attr("__mul__")(py::module_::import("numpy").attr("uint8")(255));
    return image_from(picture, {.limits = limits}, "mask", warnings);
}

MeshPointer build(const py::object& source, const py::kwargs& given) {
    Request r = request_of(source, given.attr("copy")());
    std::vector<std::string> warnings;
    r.read.channels = channels_to_read(r.params, r.texture.has_value());
    const ImagePointer read = image_from(source, r.read, r.name, warnings);
    if (!r.read.values && r.params.channels.empty()) check_color(read->image, r.name);
    const bool has_mask = !r.mask.is_none();
    const ImagePointer picture =
        has_mask ? mask_picture(r.mask, r.read.limits, warnings) : std::make_shared<ImageValue>();
    const std::string mask_name = has_mask && is_path(r.mask) ? path_text(r.mask) : "mask";
    const Image& image = read->image;
    const auto mesh = std::make_shared<MeshValue>();
    const Progress progress = python_progress(r.progress);
    without_gil(r.threads, [&] {
        const auto add_warning = [&](const std::string& text) {
            warnings.push_back(cat(r.name, ": ", text));
        };
        const SourcePlan plan = plan_source(image, r.alpha, has_mask, r.params, argument_text);
        for (const std::string& warning : plan.warnings) add_warning(warning);
        Mask mask = has_mask ? in_file(mask_name,
                                       [&] {
                                           return picture_mask(picture->image, image, r.name, plan.threshold,
                                                               argument_text);
                                       })
                             : in_file(r.name, [&] { return source_mask(image, plan, argument_text); });
        const bool missing = !read->data.empty(), mask_is_data = missing && mask.empty();
        if (missing) mask = in_file(r.name, [&] { return in_both(mask, read->data); });
        Texture& texture = mesh->container.texture;
        if (r.texture)
            texture.picture = in_file(r.name, [&] {
                return encode_texture(
                    image, mask, *r.texture,
                    plan.alpha == AlphaUse::kKeep ? TextureAlpha::kOwn : TextureAlpha::kMask);
            });
        BuildResult result =
            in_file(r.name, [&] { return build_mesh_image(image, plan.params, progress, std::move(mask)); });
        mesh->missed = missed_targets(plan.params, result, r.density);
        tell_missed(r.name, mesh->missed, r.strict, warnings);
        result.mesh_image.generator = kGenerator;
        const MaskOrigin origin = mask_is_data ? MaskOrigin::kNoData
                                  : has_mask   ? MaskOrigin::kPicture
                                               : MaskOrigin::kAlpha;
        const std::string clipped = note_source(result, origin, plan.threshold, argument_text);
        if (!clipped.empty()) add_warning(clipped);
        if (r.texture) {
            extend_to_outer_edge(result.mesh_image);
            if (forget_position_steps(result.report))
                add_warning(
                    "texture stretches the mesh to the pixels' outer edge, which leaves positions on "
                    "1/32 pixel");
            texture.coords = texture_coords(result.mesh_image);
        }
        mesh->container.mesh_image = std::move(result.mesh_image);
        mesh->container.metadata = read->metadata;
        mesh->container.facts.draco = DracoMode::kEdgebreaker;
        // As in imgmesh-build: a rate counts the bits of compact layers.
        if (plan.params.map_rate > 0 && map_kind(plan.params) == MapKind::kRelaxed && !r.texture)
            mesh->container.facts.layout = LayerLayout::kCompact;
        mesh->report = std::move(result.report);
        return true;
    });
    warn(warnings);
    return mesh;
}

constexpr char kBuild[] =
    R"(build(image, *, preset=None, mask=None, alpha='auto', alpha_threshold=None, texture=None,
      strict=False, progress=None, threads=None, **parameters) -> Mesh

Builds a mesh with a pixel map from an image, as imgmesh-build does: the same parameters give the same container.

image            a path, an Image, or an array as Image takes it. An array is converted once to float32; uint8
                 and uint16 are sRGB, floats are linear.
preset           fast, default, best, max, small or fem: values for many parameters, over which those that are
                 given count
mask             a path, an Image or an array (bool too), height x width: only pixels whose alpha, or else
                 brightness, reaches the threshold are meshed
alpha            keep it as a channel of the mesh, cut the image where it is below the threshold, ignore it; auto
                 keeps what is soft and cuts the rest
alpha_threshold  the least alpha, or brightness of a mask, of the pixels that are meshed, above 0 to 1
texture          png or jpeg: put the image on the meshes, for engines and viewers
strict           a number that cannot be reached, as of faces, is an UnsupportedError instead of a warning
progress         called with the fraction done, 0 to 1, and the name of the stage, a few times a second
threads          the most threads; the result is the same for any number

The parameters are those of imgmesh-build with underscores: faces=2000, level_faces=[8000, 2000], metric='hoppe',
channels=['R', 'G', 'B', 'depth.Z'] or {'R': 1, 'G': 1, 'B': 1, 'depth.Z': 0.5}; build_parameters() lists them.
color_space, part, layer, non_finite, nodata and max_pixels are those of read_image().

Other Python threads run meanwhile, and Ctrl-C or an exception of progress ends the build. Raises ArgumentError
for a parameter out of range, TypeError for one that does not exist, UnsupportedError for an image without what
is asked for, and as read_image() does.)";

}  // namespace

void bind_build(py::module_& module) {
    module.def("build", build, py::arg("image"), kBuild);
    module.def(
        "build_parameters", list_build_params,
        "build_parameters() -> list of dict\n\nThe parameters of build() that docs/parameters.md describes, "
        "each with its name, group, help, default and words.");
}

}  // namespace imgmesh::python
