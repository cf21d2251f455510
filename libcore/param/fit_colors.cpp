#include "libcore/param/fit_colors.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "libcore/base/parallel.h"
#include "libcore/image/channel_count.h"
#include "libcore/image/color_levels.h"
#include "libcore/mesh/adjacency.h"
#include "libcore/mesh/vertex_coloring.h"

namespace imgmesh {
namespace {

// Source: projected block Gauss-Seidel. The features of one vertex share one weight, so its best colour is
// the one in the gamut nearest to its unconstrained best. in_gamut() finds a close one, not the nearest. If
// that is farther away than the present colour, the colour stays, so the error never rises. Other features
// have no gamut.

// A colour of the gamut, or one of its levels, that is close to another.
struct Limit {
    const FeatureSpace& space;
    const ColorLevels* levels;

    Vec3f operator()(const Vec3f& color) const {
        const float weight = space.color_weight;
        if (levels) return weight * levels->rounded(color / weight);
        if (weight == 1) return in_gamut(color, space.gamut);
        return weight * in_gamut(color / weight, space.gamut);
    }
};
void set_color(BaseMesh& mesh, Id v, const Vec3f& color) {
    std::copy(color.data(), color.data() + 3, mesh.feature_of(v));
}

// What the pixels of one face contribute to its three corners: for each corner the sums of w w', then those
// of w feature'. There is room for C features.
template <int C>
struct FaceSums {
    double row[3][3 + C] = {};

    double gram(std::size_t a, std::size_t b) const { return row[a][b]; }
    double rhs(std::size_t a, int c) const { return row[a][3 + c]; }
    void add(const FaceSums& other) {
        for (int a = 0; a < 3; ++a)
            for (int k = 0; k < 3 + C; ++k) row[a][k] += other.row[a][k];
    }
};

// Exactly C features if C is 3, so that the usual case has loops of fixed length; otherwise at most C.
template <int C>
int feature_count(int channels) {
    return C == 3 ? 3 : channels;
}

// The sums over some of the pixels, for the faces from `first` on.
template <int C>
struct PartialSums {
    Id first = 0;
    std::vector<FaceSums<C>> sums;

    PartialSums() = default;
    PartialSums(const FeatureImage& feature, const std::vector<FitTerm>& terms, std::size_t begin,
                std::size_t end) {
        const int features = feature_count<C>(feature.channels);
        Id least = kNone, most = 0;
        for (const FitTerm& term : terms)
            for (std::size_t i = begin; i < end; ++i)
                if (const Id face = (*term.map)[i].face; face != kNone) {
                    least = std::min(least, face);
                    most = std::max(most, face);
                }
        if (least == kNone) return;
        first = least;
        sums.resize(most - least + 1);
        for (const FitTerm& term : terms)
            for (std::size_t i = begin; i < end; ++i) {
                const PixelCoord& coord = (*term.map)[i];
                if (coord.face == kNone) continue;
                double values[3 + C] = {1.0 - coord.u - coord.v, coord.u, coord.v};
                const float* f = feature.pixel(i);
                for (int c = 0; c < features; ++c) values[3 + c] = f[c];
                FaceSums<C>& sum = sums[coord.face - first];
                for (int a = 0; a < 3; ++a) {
                    const double w = term.weight * values[a];
                    for (int k = 0; k < 3 + features; ++k) sum.row[a][k] += w * values[k];
                }
            }
    }
    bool holds(std::size_t face) const { return face >= first && face - first < sums.size(); }
};

template <int C>
std::vector<FaceSums<C>> sum_over_pixels(const BaseMesh& mesh, const FeatureImage& feature,
                                         const std::vector<FitTerm>& terms) {
    // Each part has sums for up to all faces, so the number of parts is limited by the memory they take.
    constexpr std::size_t kParts = 8;
    constexpr int kGrainFaces = 4096;
    const std::size_t pixels = feature.pixel_count();
    PartialSums<C> parts[kParts];
    parallel_blocks(0, kParts, 1, [&](int begin, int) {
        const std::size_t part = as_index(begin);
        parts[part] = PartialSums<C>(feature, terms, part * pixels / kParts, (part + 1) * pixels / kParts);
    });
    std::vector<FaceSums<C>> sums(mesh.faces.size());
    parallel_blocks(0, as_int(sums.size()), kGrainFaces, [&](int begin, int end) {
        for (std::size_t f = as_index(begin); f < as_index(end); ++f)
            for (const PartialSums<C>& part : parts)
                if (part.holds(f)) sums[f].add(part.sums[f - part.first]);
    });
    return sums;
}

// The normal equations of one vertex: diagonal x + sum of weight other = rhs.
template <int C>
struct VertexSystem {
    Id vertex;
    double diagonal;
    double rhs[C];
    std::size_t first_link;
};
struct Link {
    Id other;
    float weight;
};

// The equations of some vertices, in the order of `members`, so that each pass reads them in sequence.
template <int C>
struct ClassSystem {
    std::vector<VertexSystem<C>> vertices;
    std::vector<Link> links;

    ClassSystem(const BaseMesh& mesh, const std::vector<FaceSums<C>>& sums, const VertexCorners& corners,
                const std::vector<Id>& members) {
        const int features = feature_count<C>(mesh.channels);
        vertices.reserve(members.size() + 1);
        for (const Id v : members) {
            VertexSystem<C>& system = vertices.emplace_back(VertexSystem<C>{v, 0, {}, links.size()});
            for (const std::size_t corner : corners.of(v)) {
                const FaceSums<C>& sum = sums[corner / 3];
                const Face& face = mesh.faces[corner / 3];
                const std::size_t a = corner % 3;
                system.diagonal += sum.gram(a, a);
                for (int c = 0; c < features; ++c) system.rhs[c] += sum.rhs(a, c);
                for (const std::size_t b : {(a + 1) % 3, (a + 2) % 3})
                    links.push_back({face[b], static_cast<float>(sum.gram(a, b))});
            }
        }
        vertices.push_back({kNone, 0, {}, links.size()});
    }
};

template <int C>
void fit(BaseMesh& mesh, const FeatureImage& feature, const std::vector<FitTerm>& terms,
         const FeatureSpace& space, const Limit& limited) {
    const int features = feature_count<C>(mesh.channels);
    constexpr int kGrain = 512;
    // Class by class: no two vertices of a class share a face, so no thread sees another's change.
    const std::vector<std::vector<Id>> classes = vertex_coloring(mesh.faces, mesh.vertex_count());
    std::vector<std::optional<ClassSystem<C>>> systems(classes.size());
    {
        const std::vector<FaceSums<C>> sums = sum_over_pixels<C>(mesh, feature, terms);
        const VertexCorners corners = vertex_corners(mesh.faces, mesh.vertex_count());
        parallel_blocks(0, as_int(classes.size()), 1, [&](int n, int) {
            const std::size_t k = as_index(n);
            systems[k].emplace(mesh, sums, corners, classes[k]);
        });
    }
    // A vertex that only pixels with tiny weights touch is hardly determined. Pull it weakly to its present
    // value.
    constexpr double kPull = 1e-3;
    // The normal equations have a mass matrix: each pass shrinks an error to a third or less. More than 6
    // passes change the RMS in the fourth digit.
    constexpr int kPasses = 6;
    if (space.color)
        parallel_blocks(0, as_int(mesh.vertex_count()), kGrain, [&](int begin, int end) {
            for (Id v = as_id(begin); v < as_id(end); ++v)
                set_color(mesh, v, limited(Vec3f(mesh.feature_of(v))));
        });
    const auto improve = [&](const ClassSystem<C>& all, std::size_t n) {
        const VertexSystem<C>& system = all.vertices[n];
        float* own = mesh.feature_of(system.vertex);
        const double diagonal = system.diagonal + kPull;
        double rhs[C];
        for (int c = 0; c < features; ++c) rhs[c] = system.rhs[c] + kPull * own[c];
        for (std::size_t k = system.first_link; k < all.vertices[n + 1].first_link; ++k) {
            const float* other = mesh.feature_of(all.links[k].other);
            for (int c = 0; c < features; ++c) rhs[c] -= double{all.links[k].weight} * other[c];
        }
        int c = 0;
        if (space.color) {
            const Vec3f color(own), best = (Vec3d(rhs) / diagonal).cast<float>(), next = limited(best);
            if ((next - best).squaredNorm() < (color - best).squaredNorm())
                set_color(mesh, system.vertex, next);
            c = 3;
        }
        for (; c < features; ++c) own[c] = static_cast<float>(rhs[c] / diagonal);
    };
    for (int pass = 0; pass < kPasses; ++pass)
        for (const std::optional<ClassSystem<C>>& system : systems)
            parallel_blocks(0, as_int(system->vertices.size()) - 1, kGrain, [&](int begin, int end) {
                for (int n = begin; n < end; ++n) improve(*system, as_index(n));
            });
}

}  // namespace

void fit_colors(BaseMesh& mesh, const FeatureImage& feature, const std::vector<FitTerm>& terms,
                const FeatureSpace& space, const ColorLevels* levels) {
    const Limit limited{space, levels};
    if (mesh.channels == 3)
        fit<3>(mesh, feature, terms, space, limited);
    else
        fit<kMaxFeatures>(mesh, feature, terms, space, limited);
}

}  // namespace imgmesh
