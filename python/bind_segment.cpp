// segment(): regions of a mesh's image.
#include <pybind11/stl.h>

#include <array>
#include <variant>

#include "formats/export/label_files.h"
#include "libcore/base/error.h"
#include "libcore/image/color.h"
#include "libcore/image/feature_space.h"
#include "libcore/segment/contour_map.h"
#include "libcore/segment/draw_regions.h"
#include "libcore/segment/region_colors.h"
#include "libcore/segment/regions_svg.h"
#include "libcore/segment/seeds.h"
#include "libcore/segment/segment.h"
#include "python/bind.h"
#include "python/errors.h"
#include "python/image_value.h"
#include "python/mesh_value.h"
#include "python/views.h"
#include "python/words.h"
#include "python/work.h"

namespace imgmesh::python {
namespace {

// imgmesh.Segmentation.
struct SegmentationValue {
    Segmentation result;
    FeatureImage picture;
    std::vector<RegionFacts> facts;
    SourceInfo source;

    const LabelImage& labels() const { return result.labels; }
};
using SegmentationPointer = std::shared_ptr<SegmentationValue>;

// How to segment, as imgmesh-segment has it.
struct Request {
    SegmentParams params;
    int level = 0;
    bool strict = false;
};

using Segments = std::optional<std::variant<std::int64_t, std::string>>;

Request request_of(const std::optional<double>& threshold, const Segments& segments,
                   const std::optional<std::int64_t>& superpixels, std::int64_t min_size,
                   const std::optional<double>& compactness, const std::optional<std::string>& distance,
                   const std::optional<std::string>& quality, int level) {
    const auto refuse = [](const char* text) { throw Error(ErrorKind::kBadArgument, text); };
    if (threshold && segments) refuse("threshold and segments: expected one of them");
    if (superpixels && (threshold || segments || distance))
        refuse("superpixels and threshold, segments or distance: expected one of them");
    if (compactness && !superpixels) refuse("compactness: means something with superpixels only");
    Request r;
    r.params.threshold = threshold.value_or(r.params.threshold);
    if (segments && std::holds_alternative<std::string>(*segments)) {
        if (std::get<std::string>(*segments) != "auto") refuse("segments: expected a number or auto");
        r.params.clearest = true;
    } else if (segments) {
        r.params.segments = std::get<std::int64_t>(*segments);
    }
    r.params.superpixels = superpixels;
    r.params.min_size = min_size;
    r.params.compactness = compactness.value_or(r.params.compactness);
    r.params.distance = word_value("distance", distance, distance_choices()).value_or(r.params.distance);
    r.params.quality = word_value("quality", quality, segment_quality_choices()).value_or(r.params.quality);
    if (quality && (superpixels || r.params.distance == DistanceRule::kPaper))
        refuse(superpixels ? "quality: means nothing with superpixels"
                           : "quality: means nothing with the paper's distance");
    r.level = level;
    return r;
}

SegmentationPointer run(const MeshValue& mesh, const Request& r, const py::object& image,
                        const py::object& callback, const std::optional<int>& threads) {
    check_level(mesh, r.level);
    const MeshImage& mesh_image = mesh.mesh_image();
    if (split_names(mesh_image.source.channel_names).color.empty())
        throw Error(ErrorKind::kUnsupported, "the mesh has no colour");
    std::vector<std::string> warnings;
    ReadImageOptions colors;
    colors.channels.emplace();  // the colour and alpha
    const ImagePointer picture = image.is_none() ? nullptr : image_from(image, colors, "image", warnings);
    const Level& level = mesh_image.levels[static_cast<std::size_t>(r.level)];
    const Progress progress = python_progress(callback);
    const auto value = std::make_shared<SegmentationValue>();
    value->source = mesh_image.source;
    without_gil(threads, [&] {
        value->picture =
            picture ? luv_image(picture->image, imgmesh::Range::kClipped) : reconstruct_luv(level);
        value->result = segment(level, value->picture, r.params, progress);
        value->facts = region_facts(value->labels(), value->picture);
        return true;
    });
    if (!value->result.missed.empty()) tell_missed("segment", {value->result.missed}, r.strict, warnings);
    warn(warnings);
    return value;
}

py::array labels(const py::object& self) {
    const LabelImage& all = self.cast<SegmentationPointer>()->labels();
    return view(self, {all.height, all.width}, all.values.data());
}

py::list regions(const SegmentationValue& value) {
    py::list all;
    for (const RegionFacts& f : value.facts) {
        py::dict neighbors;
        for (const auto& [other, length] : f.neighbors) neighbors[py::int_(other)] = length;
        all.append(py::dict(py::arg("pixels") = f.pixels,
                            py::arg("luv") = py::make_tuple(f.color[0], f.color[1], f.color[2]),
                            py::arg("box") = py::make_tuple(f.box[0], f.box[1], f.box[2], f.box[3]),
                            py::arg("neighbors") = neighbors));
    }
    return all;
}

std::shared_ptr<ImageValue> image_value(Image image) {
    return std::make_shared<ImageValue>(ImageValue{std::move(image)});
}

std::vector<Vec3f> mean_colors(const SegmentationValue& value) {
    std::vector<Vec3f> colors;
    for (const RegionFacts& f : value.facts) colors.push_back(f.color);
    return colors;
}

std::shared_ptr<ImageValue> flat(const SegmentationValue& value) {
    return without_gil(
        {}, [&] { return image_value(draw_flat(value.labels(), mean_colors(value), value.source)); });
}

std::shared_ptr<ImageValue> outlines(const SegmentationValue& value) {
    return without_gil(
        {}, [&] { return image_value(draw_outlines(value.labels(), value.picture, value.source)); });
}

std::shared_ptr<ImageValue> colors(const SegmentationValue& value) {
    return without_gil(
        {}, [&] { return image_value(draw_colors(value.labels(), distinct_colors(value.facts))); });
}

std::string svg(const SegmentationValue& value, double tolerance) {
    return without_gil(
        {}, [&] { return regions_svg(region_outlines(value.labels(), tolerance), mean_colors(value)); });
}

// A pixel, or the corners of a line.
using Place = std::array<std::int64_t, 2>;
using Places = std::vector<std::variant<Place, std::vector<Place>>>;

void add_seeds(std::vector<Seed>& seeds, const Places& places, bool keep) {
    for (const auto& place : places) {
        const auto* const line = std::get_if<std::vector<Place>>(&place);
        Seed seed{{}, keep, keep ? "keep" : "drop"};
        for (const Place& p : line ? *line : std::vector<Place>{std::get<Place>(place)}) {
            seed.where += cat(seed.points.empty() ? " (" : ", (", p[0], ", ", p[1], ")");
            seed.points.push_back({p[0], p[1]});
        }
        if (!seed.points.empty()) seeds.push_back(std::move(seed));
    }
}

py::array mask(const SegmentationValue& value, const Places& keep, const Places& drop) {
    std::vector<Seed> seeds;
    add_seeds(seeds, keep, true);
    add_seeds(seeds, drop, false);
    Mask chosen = without_gil({}, [&] { return choose_by_seeds(value.result, seeds); });
    const py::ssize_t height = chosen.height, width = chosen.width;
    return array_of(std::move(chosen.values), {height, width}).attr("astype")("bool");
}

py::array contours(const SegmentationValue& value) {
    ContourMap map = without_gil({}, [&] { return contour_map(value.result.cells, value.result.hierarchy); });
    const py::ssize_t height = map.height, width = map.width;
    return array_of(std::move(map.values), {height, width});
}

void write(const SegmentationValue& value, const py::object& path, bool overwrite) {
    const std::string name = path_text(path);
    const LabelImage& all = value.labels();
    without_gil({}, [&] {
        write_labels(name, all.width, all.height, all.values, overwrite);
        return true;
    });
}

constexpr char kSegment[] =
    R"(segment(*, threshold=None, segments=None, superpixels=None, min_size=1, compactness=None, distance=None,
        quality=None, level=0,
        image=None, strict=False, progress=None, threads=None) -> Segmentation

Cuts the image of a level into regions, as imgmesh-segment does. The default is threshold=8.

threshold    merge across contours weaker than this; 4 leaves many regions, 10 few
segments     merge until this many regions are left; "auto": near the default threshold, where regions are clearest
superpixels  make this many regions of similar size that follow edges
min_size     the least number of pixels of a region
compactness  of superpixels; higher is rounder (default 4)
distance     contour (default), or paper: by mean colours
quality      default, or fast: contours are measured once, by colours in squares
level        of the pyramid, 0 the finest
image        the image itself, to measure on instead of the reconstruction: a path, an Image or an array
strict       a number of regions that cannot be had is an UnsupportedError instead of a warning
progress     called with the fraction done and the name of the stage

Raises ArgumentError for a parameter out of range.)";

constexpr char kMask[] = R"(mask(*, keep=(), drop=()) -> array

Chooses an object by pixels (x, y) inside it and around it, as imgmesh-segment --mask does, and returns height x width of
bool for build(mask=...). In place of a pixel there may be a list of them, the corners of a line.

With both, everything goes to what it is joined with first on the way up the hierarchy. With keep alone the regions that
hold these pixels are chosen, with drop alone all others.

Raises ArgumentError for a pixel outside the image or the mesh's mask, and UnsupportedError if one patch of the mesh holds
pixels of both kinds.)";

}  // namespace

void bind_segment(py::module_& module) {
    py::class_<SegmentationValue, SegmentationPointer> segmentation(
        module, "Segmentation", py::is_final(), "An image cut into regions. It never changes.");
    refuse_new(segmentation);
    segmentation
        .def_property_readonly(
            "labels", labels,
            "The region of every pixel, from 0, height x width of uint32; NO_FACE outside the "
            "mask. A read-only view.")
        .def_property_readonly(
            "count", [](const SegmentationValue& v) { return v.labels().count; }, "The number of regions.")
        .def_property_readonly(
            "regions", regions,
            "For each region a dict: pixels, luv (mean L*u*v*), box (left, top, right, bottom, "
            "inclusive), neighbors (region -> pixels of common border).")
        .def_property_readonly(
            "missed", [](const SegmentationValue& v) { return v.result.missed; },
            "Why there are not as many regions as wanted; empty if there are.")
        .def("flat", flat, "flat() -> Image\n\nDraws each region in its mean colour.")
        .def("colors", colors,
             "colors() -> Image\n\nDraws each region in a colour of its own, unlike its neighbours'.")
        .def("svg", svg, py::arg("tolerance") = kMostOutlineTolerance,
             "svg(tolerance=0.5) -> str\n\nDraws each region as a shape in its mean colour, as an SVG "
             "document. "
             "Neighbours share their borders, which stay within tolerance of the pixels' edges (0 to 0.5).")
        .def("mask", mask, py::kw_only(), py::arg("keep") = Places(), py::arg("drop") = Places(), kMask)
        .def("outlines", outlines, "outlines() -> Image\n\nDraws the image with the regions' borders.")
        .def("contours", contours,
             "contours() -> array\n\nThe ultrametric contour map, (2 height + 1) x (2 width + 1) of float32: "
             "pixel (x, y) is at [2 y + 1, 2 x + 1], and between two pixels stands the threshold at which "
             "their "
             "regions become one.")
        .def("write", write, py::arg("path"), py::kw_only(), py::arg("overwrite") = true,
             "write(path, *, overwrite=True)\n\nWrites the labels as .exr, .tif, .npy, .mat or .png.")
        .def("__repr__", [](const SegmentationValue& v) {
            return cat("<imgmesh.Segmentation of ", v.labels().width, "x", v.labels().height,
                       " pixels: ", v.labels().count, " regions>");
        });
    auto mesh = py::reinterpret_borrow<py::class_<MeshValue, MeshPointer>>(module.attr("Mesh"));
    mesh.def(
        "segment",
        [](const MeshValue& self, const std::optional<double>& threshold, const Segments& segments,
           const std::optional<std::int64_t>& superpixels, std::int64_t min_size,
           const std::optional<double>& compactness, const std::optional<std::string>& distance,
           const std::optional<std::string>& quality, int level, const py::object& image, bool strict,
           const py::object& progress, const std::optional<int>& threads) {
            Request r =
                request_of(threshold, segments, superpixels, min_size, compactness, distance, quality, level);
            r.strict = strict;
            return run(self, r, image, progress, threads);
        },
        py::kw_only(), py::arg("threshold") = py::none(), py::arg("segments") = py::none(),
        py::arg("superpixels") = py::none(), py::arg("min_size") = 1, py::arg("compactness") = py::none(),
        py::arg("distance") = py::none(), py::arg("quality") = py::none(), py::arg("level") = 0,
        py::arg("image") = py::none(), py::arg("strict") = false, py::arg("progress") = py::none(),
        py::arg("threads") = py::none(), kSegment);
}

}  // namespace imgmesh::python
