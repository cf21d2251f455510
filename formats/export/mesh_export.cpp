// Sources: "The PLY Polygon File Format" (Turk 1994); the OBJ format, Wavefront Advanced Visualizer, appendix
// B1, with the colours that MeshLab and Blender read; TexturePacker's "JSON (Hash)" export with polygons.
#include "formats/export/mesh_export.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/export/text_numbers.h"
#include "libcore/base/error.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

Vec3f srgb_of(const BaseMesh& mesh, Id v) {
    if (mesh.channels < 3) throw Error(ErrorKind::kUnsupported, "the mesh has no colour to export");
    const float* f = mesh.feature_of(v);
    const Vec3f linear = linear_from_luv(Vec3f(f[0], f[1], f[2]));
    return encoded_from_linear(ColorSpace::kSrgb, linear.cwiseMax(0.0f).cwiseMin(1.0f))
        .cwiseMax(0.0f)
        .cwiseMin(1.0f);
}

}  // namespace

std::string ply_from_mesh(const BaseMesh& mesh) {
    std::string out = cat(
        "ply\nformat ascii 1.0\ncomment imgmesh: pixels, y up; colours sRGB\nelement vertex ",
        mesh.vertex_count(),
        "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
        "property uchar blue\nelement face ",
        mesh.faces.size(), "\nproperty list uchar uint vertex_indices\nend_header\n");
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3f rgb = srgb_of(mesh, v);
        out += number_text(mesh.position[v].x()) + ' ' + number_text(-mesh.position[v].y()) + " 0";
        for (int c = 0; c < 3; ++c) out += ' ' + std::to_string(std::lround(rgb[c] * 255));
        out += '\n';
    }
    for (const auto& [a, b, c] : mesh.faces) out += cat("3 ", a, ' ', b, ' ', c, '\n');
    return out;
}

std::string obj_from_mesh(const BaseMesh& mesh, const SourceInfo& source) {
    std::string out = "# imgmesh: pixels, y up; colours sRGB\n";
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3f rgb = srgb_of(mesh, v);
        out += "v " + number_text(mesh.position[v].x()) + ' ' + number_text(-mesh.position[v].y()) + " 0";
        for (int c = 0; c < 3; ++c) out += ' ' + number_text(rgb[c]);
        out += '\n';
    }
    for (const Vec2f& p : mesh.position)
        out += "vt " + number_text((p.x() + 0.5f) / static_cast<float>(source.width)) + ' ' +
               number_text(1 - (p.y() + 0.5f) / static_cast<float>(source.height)) + '\n';
    for (const auto& [a, b, c] : mesh.faces)
        out += cat("f ", a + 1, '/', a + 1, ' ', b + 1, '/', b + 1, ' ', c + 1, '/', c + 1, '\n');
    return out;
}

std::string sprite_json_from_mesh(const BaseMesh& mesh, const SourceInfo& source, const std::string& image,
                                  const std::string& generator) {
    using nlohmann::ordered_json;
    const ordered_json size = {{"w", source.width}, {"h", source.height}};
    const ordered_json whole = {{"x", 0}, {"y", 0}, {"w", source.width}, {"h", source.height}};
    ordered_json points = ordered_json::array(), triangles = ordered_json::array();
    for (const Vec2f& p : mesh.position)
        points.push_back({from_corner(p.x(), source.width), from_corner(p.y(), source.height)});
    for (const auto& [a, b, c] : mesh.faces) triangles.push_back({a, b, c});
    const ordered_json sheet = {{"frames",
                                 {{image,
                                   {{"frame", whole},
                                    {"rotated", false},
                                    {"trimmed", false},
                                    {"spriteSourceSize", whole},
                                    {"sourceSize", size},
                                    {"vertices", points},
                                    {"verticesUV", points},
                                    {"triangles", triangles}}}}},
                                {"meta",
                                 {{"app", generator},
                                  {"version", "1.0"},
                                  {"image", image},
                                  {"format", "RGBA8888"},
                                  {"size", size},
                                  {"scale", "1"}}}};
    return sheet.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

}  // namespace imgmesh
