// The class Segmentation: cells, the order in which they merge, and drawings of any regions made of them.
#include <emscripten/bind.h>

#include <algorithm>

#include "libcore/base/error.h"
#include "libcore/base/grid_neighbors.h"
#include "libcore/image/color.h"
#include "libcore/image/feature_space.h"
#include "libcore/segment/contour_map.h"
#include "libcore/segment/draw_regions.h"
#include "libcore/segment/merge_heights.h"
#include "libcore/segment/region_colors.h"
#include "libcore/segment/region_faces.h"
#include "libcore/segment/regions_svg.h"
#include "web/engine/guarded.h"
#include "web/engine/mesh_value.h"
#include "web/engine/pixels.h"
#include "web/engine/segment_value.h"

namespace imgmesh::web {
namespace {

// Whether an option is there; null counts as absent.
bool given(const val& options, const char* name) {
    return !options[name].isUndefined() && !options[name].isNull();
}

double number(const val& options, const char* name) {
    const val value = options[name];
    if (!value.isNumber()) throw Error(ErrorKind::kBadArgument, cat(name, ": expected a number"));
    return value.as<double>();
}

std::int64_t whole(const val& options, const char* name) {
    const double value = number(options, name);
    if (!(value >= 1 && value <= 1e9) || value != double(static_cast<std::int64_t>(value)))
        throw Error(ErrorKind::kBadArgument, cat(name, ": expected a whole number from 1"));
    return static_cast<std::int64_t>(value);
}

bool is_word(const val& options, const char* name, const char* usual, const char* other) {
    const val value = options[name];
    const std::string word = value.isString() ? value.as<std::string>() : "";
    if (word != usual && word != other)
        throw Error(ErrorKind::kBadArgument, cat(name, ": expected ", usual, " or ", other));
    return word == other;
}

SegmentParams params_from(const val& options) {
    SegmentParams params;
    if (given(options, "superpixels")) params.superpixels = whole(options, "superpixels");
    if (given(options, "compactness")) params.compactness = number(options, "compactness");
    if (given(options, "minSize")) params.min_size = whole(options, "minSize");
    if (given(options, "quality") && is_word(options, "quality", "default", "fast"))
        params.quality = SegmentQuality::kFast;
    if (given(options, "distance") && is_word(options, "distance", "contour", "paper"))
        params.distance = DistanceRule::kPaper;
    return params;
}

SegmentPointer segment_mesh(const MeshPointer& mesh, int level, const val& pixels, const val& options,
                            const val& progress) {
    return guarded([&] {
        const Level& l = mesh->level(level);
        if (split_names(mesh->mesh_image.source.channel_names).color.empty())
            throw Error(ErrorKind::kUnsupported, "the mesh has no colour");
        Progress report;
        if (!progress.isNull() && !progress.isUndefined())
            report = [&](double fraction, std::string_view stage) { progress(fraction, std::string(stage)); };
        const auto value = std::make_shared<SegmentValue>();
        value->mesh = mesh;
        value->level = level;
        value->picture = pixels.isNull() || pixels.isUndefined()
                             ? reconstruct_luv(l)
                             : luv_image(image_from_pixels(pixels), Range::kClipped);
        value->result = segment(l, value->picture, params_from(options), report);
        return value;
    });
}

val facts(const SegmentValue& value) {
    return guarded([&] {
        const Segmentation& result = value.result;
        val facts = val::object();
        facts.set("width", result.cells.width);
        facts.set("height", result.cells.height);
        facts.set("cells", double(result.cells.count()));
        facts.set("merges", double(result.merges));
        facts.set("forced", double(result.hierarchy.forced));
        facts.set("missed", result.missed);
        return facts;
    });
}

val cells(const SegmentValue& value) {
    return guarded([&] { return typed_array(value.result.cells.values, "Uint32Array"); });
}

val merges(const SegmentValue& value) {
    return guarded([&] {
        std::vector<std::uint32_t> pairs;
        for (const Merge& merge : value.result.hierarchy.merges)
            pairs.insert(pairs.end(), {merge.a, merge.b});
        return typed_array(pairs, "Uint32Array");
    });
}

val heights(const SegmentValue& value) {
    return guarded([&] {
        std::vector<float> all;
        for (const Merge& merge : value.result.hierarchy.merges) all.push_back(merge.height);
        return typed_array(all, "Float32Array");
    });
}

// Pixels and the sums of L*, u* and v* of every cell.
val sums(const SegmentValue& value) {
    return guarded([&] {
        const Cells& c = value.result.cells;
        std::vector<double> all(4 * c.count());
        for (std::size_t i = 0; i < c.size(); ++i) {
            if (c[i] == kNone) continue;
            const float* const luv = value.picture.pixel(i);
            double* const sum = &all[4 * c[i]];
            sum[0] += 1;
            for (int k = 0; k < 3; ++k) sum[k + 1] += double(luv[k]);
        }
        return typed_array(all, "Float64Array");
    });
}

// The region of every face: the one that most pixels of its patch belong to.
val face_regions(const SegmentValue& value, const val& table) {
    return guarded([&] {
        const Level& level = value.mesh->level(value.level);
        return typed_array(region_of_faces(level.mesh, level.map, labels_from(value, table)), "Uint32Array");
    });
}

// a, b, length, and after how many merges the two are one; all merges and one more if they never are.
val borders(const SegmentValue& value) {
    return guarded([&] {
        const Cells& c = value.result.cells;
        Hierarchy counted = value.result.hierarchy;
        for (std::size_t k = 0; k < counted.merges.size(); ++k)
            counted.merges[k].height = static_cast<float>(k + 1);
        const MergeHeights joined(counted, 0);
        std::vector<std::pair<Id, Id>> pairs;
        for_neighbor_pixels(c, [&](std::size_t i, std::size_t j) {
            if (c[i] != c[j] && c[i] != kNone && c[j] != kNone) pairs.emplace_back(std::minmax(c[i], c[j]));
        });
        std::sort(pairs.begin(), pairs.end());
        std::vector<std::uint32_t> all;
        const auto never = double(counted.merges.size() + 1);
        for (std::size_t first = 0, last = 0; first < pairs.size(); first = last) {
            while (last < pairs.size() && pairs[last] == pairs[first]) ++last;
            const auto [a, b] = pairs[first];
            const auto merged = double(joined.between(joined.places()[a], joined.places()[b]));
            all.insert(all.end(), {a, b, static_cast<std::uint32_t>(last - first),
                                   static_cast<std::uint32_t>(std::min(merged, never))});
        }
        return typed_array(all, "Uint32Array");
    });
}

val region_list(const SegmentValue& value, const val& table) {
    return guarded([&] {
        val all = val::array();
        for (const RegionFacts& f : region_facts(labels_from(value, table), value.picture)) {
            val region = val::object();
            region.set("pixels", double(f.pixels));
            val luv = val::array(), box = val::array(), neighbors = val::array();
            for (const float c : {f.color[0], f.color[1], f.color[2]}) luv.call<void>("push", c);
            for (const int side : f.box) box.call<void>("push", side);
            for (const auto& [other, length] : f.neighbors) {
                val neighbor = val::object();
                neighbor.set("region", other);
                neighbor.set("length", double(length));
                neighbors.call<void>("push", neighbor);
            }
            region.set("luv", luv);
            region.set("box", box);
            region.set("neighbors", neighbors);
            all.call<void>("push", region);
        }
        return all;
    });
}

std::vector<Vec3f> mean_colors(const std::vector<RegionFacts>& facts) {
    std::vector<Vec3f> colors;
    for (const RegionFacts& f : facts) colors.push_back(f.color);
    return colors;
}

val draw(const SegmentValue& value, const std::string& what, const val& table) {
    return guarded([&] {
        const LabelImage labels = labels_from(value, table);
        SourceInfo source = value.mesh->mesh_image.source;
        source.color_space = ColorSpace::kSrgb;  // a canvas's, whatever the container has
        if (what == "outlines") return pixels_from_image(draw_outlines(labels, value.picture, source));
        const std::vector<RegionFacts> facts = region_facts(labels, value.picture);
        if (what == "flat") return pixels_from_image(draw_flat(labels, mean_colors(facts), source));
        if (what == "colors") return pixels_from_image(draw_colors(labels, distinct_colors(facts)));
        throw Error(ErrorKind::kBadArgument,
                    cat("drawing '", what, "': expected one of outlines, flat, colors"));
    });
}

std::string svg(const SegmentValue& value, const val& table, double tolerance) {
    return guarded([&] {
        const LabelImage labels = labels_from(value, table);
        return regions_svg(region_outlines(labels, tolerance),
                           mean_colors(region_facts(labels, value.picture)));
    });
}

val contours(const SegmentValue& value) {
    return guarded([&] {
        const ContourMap map = contour_map(value.result.cells, value.result.hierarchy);
        val contours = val::object();
        contours.set("width", map.width);
        contours.set("height", map.height);
        contours.set("data", typed_array(map.values, "Float32Array"));
        return contours;
    });
}

val mask(SegmentValue& value, const val& table, const val& keep, const val& drop) {
    return guarded([&] { return typed_array(mask_from(value, table, keep, drop).values, "Uint8Array"); });
}

}  // namespace

EMSCRIPTEN_BINDINGS(imgmesh_segment) {
    emscripten::class_<SegmentValue>("Segmentation")
        .smart_ptr<SegmentPointer>("SegmentPointer")
        .function("facts", facts)
        .function("cells", cells)
        .function("merges", merges)
        .function("heights", heights)
        .function("borders", borders)
        .function("sums", sums)
        .function("faceRegions", face_regions)
        .function("pieces", region_pieces)
        .function("regions", region_list)
        .function("draw", draw)
        .function("svg", svg)
        .function("contours", contours)
        .function("mask", mask)
        .function("maskPng", mask_png)
        .function("contourFile", contour_file);
    emscripten::function("segment", segment_mesh);
}

}  // namespace imgmesh::web
