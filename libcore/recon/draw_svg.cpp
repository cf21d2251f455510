#include <algorithm>
#include <cmath>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/recon/draw.h"
#include "libcore/recon/level_colors.h"
#include "libcore/recon/luv_encoder.h"

namespace imgmesh {
namespace {

// A number with at most two decimals, as short as SVG allows: "12", "-.5", "3.25". Hundredths of a pixel are
// far finer than what one sees, and coarser than the 1/32 that positions are multiples of.
void append_number(std::string& out, double value) {
    long hundredths = std::lround(value * 100);
    if (hundredths < 0) out += '-';
    hundredths = std::abs(hundredths);
    if (hundredths >= 100 || hundredths == 0) out += std::to_string(hundredths / 100);
    if (hundredths % 100 == 0) return;
    out += '.';
    out += static_cast<char>('0' + hundredths / 10 % 10);
    if (hundredths % 10 != 0) out += static_cast<char>('0' + hundredths % 10);
}

void append_point(std::string& out, char command, const Vec2d& p) {
    out += command;
    append_number(out, p.x());
    out += ' ';
    append_number(out, p.y());
}

// Vertices on the picture's sides move out by half a pixel, to where the outermost pixels end. Not so those
// of cut-outs, whose outlines run through pixel centres everywhere.
std::vector<Vec2d> outward(const BaseMesh& mesh, const SourceInfo& source) {
    const auto moved = [&](float x, int side) {
        if (side == 1 || source.has_mask) return double(x);  // already -0.5 .. 0.5
        if (x <= 0) return x - 0.5;
        return x >= static_cast<float>(side - 1) ? x + 0.5 : double(x);
    };
    std::vector<Vec2d> points;
    points.reserve(mesh.vertex_count());
    for (const Vec2f& p : mesh.position)
        points.emplace_back(moved(p.x(), source.width), moved(p.y(), source.height));
    return points;
}

void append_hex(std::string& out, const Vec3f& luv) {
    constexpr char kDigits[] = "0123456789abcdef";
    const Vec3f rgb = encoded_from_luv(ColorSpace::kSrgb, luv);
    out += '#';
    for (int c = 0; c < 3; ++c) {
        const auto byte = static_cast<unsigned>(std::lround(rgb[c] * 255));
        out += kDigits[byte >> 4];
        out += kDigits[byte & 15];
    }
}

// Each face is stroked in its own colour: without, renderers leave hairline gaps between neighbours.
void append_faces(std::string& out, const BaseMesh& mesh, const std::vector<Vec2d>& points) {
    const std::vector<Vec3f> colors = face_means(mesh);
    out += "<g stroke-width=\".7\" stroke-linejoin=\"round\">\n";
    std::string color;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        color.clear();
        append_hex(color, colors[f]);
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
        throw Error(ErrorCode::kUsage, "only the wire and flat drawings can be written as SVG");
    const BaseMesh& mesh = level_to_draw(mesh_image, level_index).mesh;
    const SourceInfo& source = mesh_image.source;
    const std::vector<Vec2d> points = outward(mesh, source);
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
