#include <utility>

#include "libcore/base/error.h"
#include "libcore/base/svg_text.h"
#include "libcore/image/luv_encoder.h"
#include "libcore/recon/draw.h"
#include "libcore/recon/level_colors.h"
#include "libcore/recon/svg_places.h"

namespace imgmesh {
namespace {

// Each face has a stroke in its own colour. Without it, renderers leave hairline gaps between neighbours.
void append_faces(std::string& out, const BaseMesh& mesh, const std::vector<Vec2d>& points) {
    const std::vector<Vec3f> colors = face_means(mesh);
    out += "<g stroke-width=\".7\" stroke-linejoin=\"round\">\n";
    std::string color;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        color.clear();
        append_hex(color, Vec3f(encoded_from_luv(ColorSpace::kSrgb, colors[f]) * 255).cast<double>());
        out += "<path fill=\"" + color + "\" stroke=\"" + color + "\" d=\"";
        append_point(out, 'M', points[a]);
        append_point(out, 'L', points[b]);
        append_point(out, 'L', points[c]);
        out += "z\"/>\n";
    }
    out += "</g>\n";
}

void append_edges(std::string& out, const BaseMesh& mesh, const std::vector<Vec2d>& points) {
    const std::vector<std::pair<Id, Id>> edges = mesh_edges(mesh);
    out += "<path fill=\"none\" stroke=\"#12263a\" stroke-width=\".6\" stroke-linecap=\"round\" d=\"";
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (e % 16 == 0) out += '\n';
        append_point(out, 'M', points[edges[e].first]);
        append_point(out, 'L', points[edges[e].second]);
    }
    out += "\"/>\n";
}

}  // namespace

std::string draw_svg(const MeshImage& mesh_image, int level_index, DrawMode mode) {
    if (mode != DrawMode::kWire && mode != DrawMode::kFlat)
        throw Error(ErrorKind::kBadArgument, "only the wire and flat drawings can be written as SVG");
    const BaseMesh& mesh = level_to_draw(mesh_image, level_index).mesh;
    const SourceInfo& source = mesh_image.source;
    const std::vector<Vec2d> points = outward(mesh_image.levels[as_index(level_index)], source);
    std::string out = cat("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"", source.width, "\" height=\"",
                          source.height, "\" viewBox=\"-.5 -.5 ", source.width, ' ', source.height, "\">\n");
    if (mode == DrawMode::kFlat)
        append_faces(out, mesh, points);
    else
        append_edges(out, mesh, points);
    out += "</svg>\n";
    return out;
}

}  // namespace imgmesh
