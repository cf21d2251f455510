#include "libcore/param/fit_colors.h"

#include <algorithm>
#include <vector>

#include "libcore/image/channel_count.h"

namespace imgmesh {
namespace {

// Source: projected block Gauss-Seidel. The features of one vertex share one weight, so its best colour is
// the one in gamut that is nearest to its unconstrained best. in_gamut() finds one close by, not the nearest:
// where that is farther away than the colour at hand, the colour stays, and the error never rises.
// Other features have no gamut.

Vec3f limited(const Vec3f& color, const FeatureSpace& space) {
    if (space.color_weight == 1) return in_gamut(color, space.gamut);
    return space.color_weight * in_gamut(color / space.color_weight, space.gamut);
}
void set_color(BaseMesh& mesh, Id v, const Vec3f& color) {
    std::copy(color.data(), color.data() + 3, mesh.feature_of(v));
}

// What the pixels of one face say about its three corners: sums of w w' and of w feature'. Room for C
// features.
template <int C>
struct FaceSums {
    double gram[3][3] = {};
    double rhs[3][C] = {};
};

// Of C features exactly where C is 3, so that the usual case has loops of fixed length; else of up to C.
template <int C>
int feature_count(const BaseMesh& mesh) {
    if constexpr (C == 3)
        return 3;
    else
        return mesh.channels;
}

template <int C>
std::vector<FaceSums<C>> sum_over_pixels(const BaseMesh& mesh, const FeatureImage& feature,
                                         const std::vector<FitTerm>& terms) {
    const int features = feature_count<C>(mesh);
    std::vector<FaceSums<C>> sums(mesh.faces.size());
    for (const FitTerm& term : terms)
        for (std::size_t i = 0; i < term.map->coords.size(); ++i) {
            const PixelCoord& coord = term.map->coords[i];
            if (coord.face == kNone) continue;
            const double w[3] = {1.0 - coord.u - coord.v, coord.u, coord.v};
            FaceSums<C>& sum = sums[coord.face];
            const float* f = feature.pixel(i);
            for (int a = 0; a < 3; ++a) {
                const double wa = term.weight * w[a];
                for (int b = 0; b < 3; ++b) sum.gram[a][b] += wa * w[b];
                for (int c = 0; c < features; ++c) sum.rhs[a][c] += wa * f[c];
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

template <int C>
void fit(BaseMesh& mesh, const FeatureImage& feature, const std::vector<FitTerm>& terms,
         const FeatureSpace& space) {
    const int features = feature_count<C>(mesh);
    const std::vector<FaceSums<C>> sums = sum_over_pixels<C>(mesh, feature, terms);
    const CornersOfVertices corners = corners_of_vertices(mesh);
    // A vertex that only pixels with tiny weights touch would be free to run away: pull it weakly to where it
    // is.
    constexpr double kPull = 1e-3;
    // The normal equations are those of a mass matrix: each pass shrinks an error to a third or less. More
    // than 6 passes change the RMS in the fourth digit.
    constexpr int kPasses = 6;
    for (Id v = 0; space.color && v < mesh.vertex_count(); ++v)
        set_color(mesh, v, limited(Vec3f(mesh.feature_of(v)), space));
    for (int pass = 0; pass < kPasses; ++pass) {
        for (Id v = 0; v < mesh.vertex_count(); ++v) {
            double diagonal = kPull, rhs[C];
            for (int c = 0; c < features; ++c) rhs[c] = kPull * mesh.feature_of(v)[c];
            for (std::size_t k = corners.first[v]; k < corners.first[v + 1]; ++k) {
                const FaceSums<C>& sum = sums[corners.corner[k] / 3];
                const Face& face = mesh.faces[corners.corner[k] / 3];
                const std::size_t a = corners.corner[k] % 3;
                diagonal += sum.gram[a][a];
                for (int c = 0; c < features; ++c) rhs[c] += sum.rhs[a][c];
                for (const std::size_t b : {(a + 1) % 3, (a + 2) % 3})
                    for (int c = 0; c < features; ++c) rhs[c] -= sum.gram[a][b] * mesh.feature_of(face[b])[c];
            }
            int c = 0;
            if (space.color) {
                const Vec3f color(mesh.feature_of(v)), best = (Vec3d(rhs) / diagonal).cast<float>(),
                                                       next = limited(best, space);
                if ((next - best).squaredNorm() < (color - best).squaredNorm()) set_color(mesh, v, next);
                c = 3;
            }
            for (; c < features; ++c) mesh.feature_of(v)[c] = static_cast<float>(rhs[c] / diagonal);
        }
    }
}

}  // namespace

void fit_colors(BaseMesh& mesh, const FeatureImage& feature, const std::vector<FitTerm>& terms,
                const FeatureSpace& space) {
    if (mesh.channels == 3)
        fit<3>(mesh, feature, terms, space);
    else
        fit<kMaxFeatures>(mesh, feature, terms, space);
}

}  // namespace imgmesh
