// Regions from tables and marks of JavaScript, and their files, with the bytes that imgmesh-segment writes.
#include <cmath>

#include "formats/export/contour_files.h"
#include "formats/gltf/region_gltf.h"
#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "libcore/segment/contour_map.h"
#include "libcore/segment/region_faces.h"
#include "libcore/segment/seeds.h"
#include "web/engine/file_folder.h"
#include "web/engine/guarded.h"
#include "web/engine/pixels.h"
#include "web/engine/segment_value.h"

namespace imgmesh::web {
namespace {

constexpr char kGenerator[] = "imgmesh-segment " IMGMESH_VERSION;

std::int64_t coordinate(const val& point, const char* name) {
    const val value = point[name];
    const double place = value.isNumber() ? value.as<double>() : NAN;
    if (!(std::abs(place) < 1e9))
        throw Error(ErrorKind::kBadArgument, cat(name, ": expected a pixel's place"));
    return std::llround(place);
}

void add_seeds(std::vector<Seed>& seeds, const val& lines, bool keep) {
    for (const val& line : emscripten::vecFromJSArray<val>(lines)) {
        Seed seed{{}, keep, keep ? "keep" : "drop"};
        for (const val& point : emscripten::vecFromJSArray<val>(line)) {
            const std::int64_t x = coordinate(point, "x"), y = coordinate(point, "y");
            seed.where += cat(seed.points.empty() ? " (" : ", (", x, ", ", y, ")");
            seed.points.push_back({x, y});
        }
        if (!seed.points.empty()) seeds.push_back(std::move(seed));
    }
}

}  // namespace

LabelImage labels_from(const SegmentValue& value, const val& table) {
    const Cells& cells = value.result.cells;
    std::vector<std::uint32_t> regions(table["length"].as<std::size_t>());
    if (regions.size() != cells.count())
        throw Error(ErrorKind::kBadArgument,
                    cat("the table has ", regions.size(), " regions of cells, expected ", cells.count()));
    val(emscripten::typed_memory_view(regions.size(), regions.data())).call<void>("set", table);
    Id count = 0;
    for (const Id region : regions) {
        if (region > count)
            throw Error(ErrorKind::kBadArgument, "regions are not numbered by their first cells");
        count = std::max(count, region + 1);
    }
    LabelImage labels(cells, count);
    for (Id& label : labels)
        if (label != kNone) label = regions[label];
    return labels;
}

Mask mask_from(SegmentValue& value, const val& table, const val& keep, const val& drop) {
    std::vector<Seed> seeds;
    add_seeds(seeds, keep, true);
    add_seeds(seeds, drop, false);
    value.result.labels = labels_from(value, table);
    return choose_by_seeds(value.result, seeds);
}

val mask_png(SegmentValue& value, const val& table, const val& keep, const val& drop) {
    return guarded([&] {
        const Mask mask = mask_from(value, table, keep, drop);
        return typed_array(encode_image("mask.png", mask_image(mask), SampleType::kUint8), "Uint8Array");
    });
}

val region_pieces(const SegmentValue& value, const val& table) {
    return guarded([&] {
        const Level& level = value.mesh->level(value.level);
        const std::vector<Id> regions = region_of_faces(level.mesh, level.map, labels_from(value, table));
        const FileFolder folder;
        write_region_mesh("regions.glb", level.mesh, regions, value.mesh->mesh_image.source, kGenerator,
                          true);
        return folder.bytes("regions.glb");
    });
}

val contour_file(const SegmentValue& value, const std::string& name) {
    return guarded([&] {
        check_file_name(name);
        const ContourMap map = contour_map(value.result.cells, value.result.hierarchy);
        const FileFolder folder;
        write_contours(name, map.width, map.height, map.values, SegmentParams{}.threshold, true);
        return folder.bytes(name);
    });
}

}  // namespace imgmesh::web
