#include "libcore/param/fit_colors.h"

#include <algorithm>
#include <vector>

#include "libcore/image/color.h"

namespace imgmesh {
namespace {

// Source: projected block Gauss-Seidel. The features of one vertex share one weight, so its best colour is
// the one in gamut that is nearest to its unconstrained best. in_gamut() finds one close by, not the nearest:
// where that is farther away than the colour at hand, the colour stays, and the error never rises.
constexpr int C = 3;

Vec3f color_of(const BaseMesh& mesh, Id v) {
    return Vec3f(mesh.feature_of(v));
}
void set_color(BaseMesh& mesh, Id v, const Vec3f& color) {
    std::copy(color.data(), color.data() + C, mesh.feature_of(v));
}

// What the pixels of one face say about its three corners: sums of w w' and of w feature'.
struct FaceSums {
    double gram[3][3] = {};
    double rhs[3][C] = {};
};

std::vector<FaceSums> sum_over_pixels(const BaseMesh& mesh, const FeatureImage& feature,
                                      const std::vector<FitTerm>& terms) {
    std::vector<FaceSums> sums(mesh.faces.size());
    for (const FitTerm& term : terms)
        for (std::size_t i = 0; i < term.map->coords.size(); ++i) {
            const PixelCoord& coord = term.map->coords[i];
            if (coord.face == kNone) continue;
            const double w[3] = {1.0 - coord.u - coord.v, coord.u, coord.v};
            FaceSums& sum = sums[coord.face];
            const float* f = feature.pixel(i);
            for (int a = 0; a < 3; ++a) {
                const double wa = term.weight * w[a];
                for (int b = 0; b < 3; ++b) sum.gram[a][b] += wa * w[b];
                for (int c = 0; c < C; ++c) sum.rhs[a][c] += wa * f[c];
            }
        }
    return sums;
}

// For every vertex the corners of faces that it is, as face * 3 + corner: those of v from first[v] to first[v
// + 1].
struct CornersOfVertices {
    std::vector<std::size_t> first, corner;
};

CornersOfVertices corners_of_vertices(const BaseMesh& mesh) {
    CornersOfVertices out;
    out.first.assign(mesh.vertex_count() + 1, 0);
    for (const Face& face : mesh.faces)
        for (const Id v : face) ++out.first[v + 1];
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) out.first[v + 1] += out.first[v];
    out.corner.resize(mesh.faces.size() * 3);
    std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t a = 0; a < 3; ++a) out.corner[next[mesh.faces[f][a]]++] = f * 3 + a;
    return out;
}

}  // namespace

void fit_colors(BaseMesh& mesh, const FeatureImage& feature, const std::vector<FitTerm>& terms) {
    const std::vector<FaceSums> sums = sum_over_pixels(mesh, feature, terms);
    const CornersOfVertices corners = corners_of_vertices(mesh);
    // A vertex that only pixels with tiny weights touch would be free to run away: pull it weakly to where it
    // is.
    constexpr double kPull = 1e-3;
    // The normal equations are those of a mass matrix: each pass shrinks an error to a third or less. More
    // than 6 passes change the RMS in the fourth digit.
    constexpr int kPasses = 6;
    for (Id v = 0; v < mesh.vertex_count(); ++v) set_color(mesh, v, in_gamut(color_of(mesh, v)));
    for (int pass = 0; pass < kPasses; ++pass) {
        for (Id v = 0; v < mesh.vertex_count(); ++v) {
            const Vec3f color = color_of(mesh, v);
            double diagonal = kPull;
            Vec3d rhs = kPull * color.cast<double>();
            for (std::size_t k = corners.first[v]; k < corners.first[v + 1]; ++k) {
                const FaceSums& sum = sums[corners.corner[k] / 3];
                const Face& face = mesh.faces[corners.corner[k] / 3];
                const std::size_t a = corners.corner[k] % 3;
                diagonal += sum.gram[a][a];
                rhs += Vec3d(sum.rhs[a]);
                for (const std::size_t b : {(a + 1) % 3, (a + 2) % 3})
                    rhs -= sum.gram[a][b] * color_of(mesh, face[b]).cast<double>();
            }
            const Vec3f best = (rhs / diagonal).cast<float>(), next = in_gamut(best);
            if ((next - best).squaredNorm() < (color - best).squaredNorm()) set_color(mesh, v, next);
        }
    }
}

}  // namespace imgmesh
