// The class Mesh: its arrays, drawings and figures.
#include <emscripten/bind.h>

#include "formats/export/mesh_export.h"
#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"
#include "libcore/metrics/compare_images.h"
#include "libcore/metrics/metrics.h"
#include "libcore/recon/draw.h"
#include "libcore/recon/level_colors.h"
#include "web/engine/guarded.h"
#include "web/engine/mesh_files.h"
#include "web/engine/mesh_value.h"
#include "web/engine/pixels.h"

namespace imgmesh::web {

const Level& MeshValue::level(int index) const {
    return checked_level(mesh_image, index);
}

namespace {

DrawMode mode_from(const std::string& word) {
    if (word == "map") return DrawMode::kMap;
    if (word == "gouraud") return DrawMode::kGouraud;
    if (word == "wire") return DrawMode::kWire;
    if (word == "patches") return DrawMode::kPatches;
    if (word == "flat") return DrawMode::kFlat;
    if (word == "visits") return DrawMode::kVisits;
    throw Error(ErrorKind::kBadArgument,
                cat("mode '", word, "': expected one of map, gouraud, wire, patches, flat, visits"));
}

val facts(const MeshValue& mesh) {
    return guarded([&] {
        const MeshImage& m = mesh.mesh_image;
        val facts = val::object();
        facts.set("width", m.source.width);
        facts.set("height", m.source.height);
        facts.set("hasMask", m.source.has_mask);
        val channels = val::array();
        for (const std::string& name : m.source.channel_names) channels.call<void>("push", name);
        facts.set("channels", channels);
        facts.set("hasColor", !split_names(m.source.channel_names).color.empty());
        facts.set("alphaFeature", alpha_feature(m.source));
        facts.set("generator", m.generator);
        val levels = val::array();
        for (std::size_t k = 0; k < m.levels.size(); ++k) {
            val level = val::object();
            level.set("vertices", double(m.levels[k].mesh.vertex_count()));
            level.set("faces", double(m.levels[k].mesh.faces.size()));
            if (mesh.report) {
                level.set("rms", mesh.report->levels[k].map_rms);
                level.set("meshRms", mesh.report->levels[k].gouraud_rms);
            }
            levels.call<void>("push", level);
        }
        facts.set("levels", levels);
        val parameters = val::object();
        for (const BuildParameter& parameter : m.parameters)
            std::visit(
                [&](const auto& value) {
                    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::int64_t>)
                        parameters.set(parameter.first, double(value));
                    else
                        parameters.set(parameter.first, value);
                },
                parameter.second);
        facts.set("parameters", parameters);
        val warnings = val::array();
        for (const std::string& warning : mesh.warnings) warnings.call<void>("push", warning);
        facts.set("warnings", warnings);
        return facts;
    });
}

val positions(const MeshValue& mesh, int level) {
    return guarded([&] {
        std::vector<float> flat;
        for (const Vec2f& p : mesh.level(level).mesh.position) flat.insert(flat.end(), {p.x(), p.y()});
        return typed_array(flat, "Float32Array");
    });
}

val faces(const MeshValue& mesh, int level) {
    return guarded([&] {
        std::vector<std::uint32_t> flat;
        for (const Face& f : mesh.level(level).mesh.faces) flat.insert(flat.end(), f.begin(), f.end());
        return typed_array(flat, "Uint32Array");
    });
}

val edges(const MeshValue& mesh, int level) {
    return guarded([&] {
        std::vector<std::uint32_t> flat;
        for (const auto& edge : mesh_edges(mesh.level(level).mesh))
            flat.insert(flat.end(), {edge.first, edge.second});
        return typed_array(flat, "Uint32Array");
    });
}

val features(const MeshValue& mesh, int level) {
    return guarded([&] { return typed_array(mesh.level(level).mesh.feature, "Float32Array"); });
}

val face_ids(const MeshValue& mesh, int level) {
    return guarded([&] {
        const PixelMap& map = mesh.level(level).map;
        std::vector<std::uint32_t> ids;
        ids.reserve(map.values.size());
        for (const PixelCoord& c : map.values) ids.push_back(c.face);
        return typed_array(ids, "Uint32Array");
    });
}

val barycentrics(const MeshValue& mesh, int level) {
    return guarded([&] {
        const PixelMap& map = mesh.level(level).map;
        std::vector<float> weights;
        weights.reserve(2 * map.values.size());
        for (const PixelCoord& c : map.values) {
            weights.push_back(c.u);
            weights.push_back(c.v);
        }
        return typed_array(weights, "Float32Array");
    });
}

val draw_mesh(const MeshValue& mesh, const std::string& mode, int level, double scale) {
    return guarded([&] { return pixels_from_image(draw(mesh.mesh_image, level, {mode_from(mode), scale})); });
}

std::string svg(const MeshValue& mesh, const std::string& mode, int level) {
    return guarded([&] {
        if (mode == "gradient") return draw_svg_gradient(mesh.mesh_image, level);
        return draw_svg(mesh.mesh_image, level, mode_from(mode));
    });
}

// Counts what must be 0 in every mesh: faces and triangles of pixels that are turned over.
val quality(const MeshValue& mesh, int level) {
    return guarded([&] {
        const Level& l = mesh.level(level);
        const MeshQuality shape = mesh_quality(l.mesh);
        const MapQuality map = map_quality(l.mesh, l.map, mesh.mesh_image.source.has_mask);
        val figures = val::object();
        figures.set("flippedFaces", double(shape.flipped_faces));
        figures.set("flippedPixelTriangles", double(map.flipped_triangles));
        figures.set("meanShape", shape.mean_shape);
        figures.set("minAngle", shape.min_angle_deg);
        figures.set("meanDisplacement", map.mean_displacement);
        return figures;
    });
}

// Of the reconstruction against the pixels.
val compare(const MeshValue& mesh, const val& pixels, int level) {
    return guarded([&] {
        const ImageDifference d = compare_images(image_from_pixels(pixels), draw(mesh.mesh_image, level, {}));
        val figures = val::object();
        figures.set("rmsLuv", d.rms_luv);
        figures.set("rmsRgb", d.rms_rgb);
        figures.set("psnr", d.psnr);
        figures.set("ssim", d.ssim);
        return figures;
    });
}

}  // namespace

EMSCRIPTEN_BINDINGS(imgmesh_mesh) {
    emscripten::class_<MeshValue>("Mesh")
        .smart_ptr<MeshPointer>("MeshPointer")
        .function("facts", facts)
        .function("positions", positions)
        .function("faces", faces)
        .function("edges", edges)
        .function("features", features)
        .function("faceIds", face_ids)
        .function("barycentrics", barycentrics)
        .function("draw", draw_mesh)
        .function("svg", svg)
        .function("quality", quality)
        .function("compare", compare)
        .function("save", save_container)
        .function("exportText", export_text)
        .function("exportTextured", export_textured);
}

}  // namespace imgmesh::web
