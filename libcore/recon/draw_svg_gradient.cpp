// SVG cannot give colours to the corners of a triangle. It has linear gradients, whose colour changes along
// one direction. The gradient used here is the nearest to the affine interpolation of the three corners'
// colours, by least squares over the triangle.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/base/svg_text.h"
#include "libcore/image/luv_encoder.h"
#include "libcore/recon/draw.h"
#include "libcore/recon/level_colors.h"
#include "libcore/recon/svg_places.h"

namespace imgmesh {
namespace {

using Vec4d = Eigen::Vector4d;

// Less alpha is nothing, and more is opaque, to 8 bits.
constexpr double kVisible = 0.5 / 255, kOpaque = 1 - kVisible;

struct Gradient {
    Vec2d from, to;              // ends of the gradient
    Vec4d from_color, to_color;  // encoded sRGB, as SVG blends, and alpha
};

// The colour c(p) = mean + J (p - centre) has a 4 x 2 matrix J. The best approximation of J of rank one is J
// b b^T, where b is the eigenvector of J^T J with the larger eigenvalue. Along b the colour changes by J b,
// across b it does not change. A symmetric matrix (xx, xy; xy, yy) has this eigenvector at half the angle of
// the vector (xx - yy, 2 xy).
Gradient fit_gradient(const std::array<Vec2d, 3>& p, const std::array<Vec4d, 3>& color) {
    const Vec2d centre = (p[0] + p[1] + p[2]) / 3;
    const Vec4d mean = (color[0] + color[1] + color[2]) / 3;
    Eigen::Matrix2d edges;
    edges << p[1] - p[0], p[2] - p[0];
    Eigen::Matrix<double, 4, 2> changes;
    changes << color[1] - color[0], color[2] - color[0];
    const Eigen::Matrix<double, 4, 2> jacobian = changes * edges.inverse();  // faces have area
    const Eigen::Matrix2d squares = jacobian.transpose() * jacobian;
    const double angle = std::atan2(2 * squares(0, 1), squares(0, 0) - squares(1, 1)) / 2;
    const Vec2d direction(std::cos(angle), std::sin(angle));
    const Vec4d change = jacobian * direction;
    double least = 0, most = 0;
    for (const Vec2d& corner : p) {
        const double t = direction.dot(corner - centre);
        least = std::min(least, t);
        most = std::max(most, t);
    }
    return {centre + least * direction, centre + most * direction, mean + least * change,
            mean + most * change};
}

// 8-bit codes of encoded sRGB, clipped: the ends of a gradient may lie outside the display's gamut.
Vec3d codes(const Vec4d& color) {
    return color.head<3>().cwiseMax(0.0).cwiseMin(1.0) * 255;
}

void append_attribute(std::string& out, const char* name, double value) {
    out += name;
    append_number(out, value);
    out += '"';
}

void append_stop(std::string& out, const Vec4d& color) {
    out += " stop-color=\"";
    append_hex(out, codes(color));
    out += '"';
    if (color[3] < kOpaque) append_attribute(out, " stop-opacity=\"", std::max(color[3], 0.0));
    out += "/>";
}

void append_gradient(std::string& out, std::size_t id, const Gradient& g) {
    out += "<linearGradient id=\"g" + std::to_string(id) + "\" gradientUnits=\"userSpaceOnUse\"";
    append_attribute(out, " x1=\"", g.from.x());
    append_attribute(out, " y1=\"", g.from.y());
    append_attribute(out, " x2=\"", g.to.x());
    append_attribute(out, " y2=\"", g.to.y());
    out += "><stop";
    append_stop(out, g.from_color);
    out += "<stop offset=\"1\"";
    append_stop(out, g.to_color);
    out += "</linearGradient>\n";
}

}  // namespace

std::string draw_svg_gradient(const MeshImage& mesh_image, int level_index) {
    const BaseMesh& mesh = level_to_draw(mesh_image, level_index).mesh;
    const SourceInfo& source = mesh_image.source;
    const std::vector<Vec2d> points = outward(mesh_image.levels[as_index(level_index)], source);
    const int alpha = alpha_feature(source);
    std::vector<Vec4d> colors(mesh.vertex_count());
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const float* f = mesh.feature_of(v);
        colors[v] << encoded_from_luv(ColorSpace::kSrgb, Vec3f(f[0], f[1], f[2])).cast<double>(),
            alpha >= 0 ? f[alpha] : 1.0;
    }
    std::string defs, paths;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        const auto [least, most] = std::minmax({colors[a][3], colors[b][3], colors[c][3]});
        if (most < kVisible) continue;
        const Gradient gradient =
            fit_gradient({points[a], points[b], points[c]}, {colors[a], colors[b], colors[c]});
        append_gradient(defs, f, gradient);
        const std::string paint = "url(#g" + std::to_string(f) + ")";
        paths += "<path fill=\"" + paint + "\"";
        // A stroke in the face's own colours: without it, renderers leave hairline gaps between neighbours.
        // Strokes that one sees through would show as lines themselves.
        if (least >= kOpaque) paths += " stroke=\"" + paint + "\"";
        paths += " d=\"";
        append_point(paths, 'M', points[a]);
        append_point(paths, 'L', points[b]);
        append_point(paths, 'L', points[c]);
        paths += "z\"/>\n";
    }
    return cat("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"", source.width, "\" height=\"",
               source.height, "\" viewBox=\"-.5 -.5 ", source.width, ' ', source.height, "\">\n<defs>\n",
               defs, "</defs>\n<g stroke-width=\".7\" stroke-linejoin=\"round\">\n", paths, "</g>\n</svg>\n");
}

}  // namespace imgmesh
