#include "libcore/param/fit_colors.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "libcore/base/parallel.h"
#include "libcore/image/channel_count.h"
#include "libcore/image/color_levels.h"
#include "libcore/mesh/adjacency.h"
#include "libcore/mesh/vertex_coloring.h"
#include "libcore/param/color_sums.h"

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

// Exactly C features if C is 3, so that the usual case has loops of fixed length; otherwise at most C.
template <int C>
int feature_count(int channels) {
    return C == 3 ? 3 : channels;
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

    ClassSystem(const BaseMesh& mesh, const ColorSums& sums, const VertexCorners& corners,
                const std::vector<Id>& members) {
        const int features = feature_count<C>(mesh.channels);
        vertices.reserve(members.size() + 1);
        for (const Id v : members) {
            VertexSystem<C>& system = vertices.emplace_back(VertexSystem<C>{v, 0, {}, links.size()});
            for (const std::size_t corner : corners.of(v)) {
                const Face& face = mesh.faces[corner / 3];
                const std::size_t a = corner % 3;
                const double* row = sums.row(corner / 3, a);
                system.diagonal += row[a];
                for (int c = 0; c < features; ++c) system.rhs[c] += row[3 + c];
                for (const std::size_t b : {(a + 1) % 3, (a + 2) % 3})
                    links.push_back({face[b], static_cast<float>(row[b])});
            }
        }
        vertices.push_back({kNone, 0, {}, links.size()});
    }
};

template <int C>
void fit(BaseMesh& mesh, const ColorSums& sums, const FeatureSpace& space, const Limit& limited, int passes,
         std::span<const std::uint8_t> kept) {
    const int features = feature_count<C>(mesh.channels);
    constexpr int kGrain = 512;
    // Class by class: no two vertices of a class share a face, so no thread sees another's change.
    std::vector<std::vector<Id>> classes = vertex_coloring(mesh.faces, mesh.vertex_count());
    if (!kept.empty())
        for (std::vector<Id>& members : classes) std::erase_if(members, [&](Id v) { return kept[v] != 0; });
    std::vector<std::optional<ClassSystem<C>>> systems(classes.size());
    {
        const VertexCorners corners = vertex_corners(mesh.faces, mesh.vertex_count());
        parallel_blocks(0, as_int(classes.size()), 1, [&](int n, int) {
            const std::size_t k = as_index(n);
            systems[k].emplace(mesh, sums, corners, classes[k]);
        });
    }
    // A vertex that only pixels with tiny weights touch is hardly determined. Pull it weakly to its present
    // value.
    constexpr double kPull = 1e-3;
    if (space.color)
        parallel_blocks(0, as_int(mesh.vertex_count()), kGrain, [&](int begin, int end) {
            for (Id v = as_id(begin); v < as_id(end); ++v)
                if (kept.empty() || !kept[v]) set_color(mesh, v, limited(Vec3f(mesh.feature_of(v))));
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
    for (int pass = 0; pass < passes; ++pass)
        for (const std::optional<ClassSystem<C>>& system : systems)
            parallel_blocks(0, as_int(system->vertices.size()) - 1, kGrain, [&](int begin, int end) {
                for (int n = begin; n < end; ++n) improve(*system, as_index(n));
            });
}

}  // namespace

void fit_colors(BaseMesh& mesh, const ColorSums& sums, const FeatureSpace& space, int passes,
                const ColorLevels* levels, std::span<const std::uint8_t> kept) {
    const Limit limited{space, levels};
    if (mesh.channels == 3)
        fit<3>(mesh, sums, space, limited, passes, kept);
    else
        fit<kMaxFeatures>(mesh, sums, space, limited, passes, kept);
}

void fit_colors(BaseMesh& mesh, const FeatureImage& feature, const std::vector<FitTerm>& terms,
                const FeatureSpace& space, const ColorLevels* levels, std::span<const std::uint8_t> kept) {
    // More than 6 passes change the RMS in the fourth digit.
    constexpr int kPasses = 6;
    ColorSums sums{mesh.channels, {}};
    for (const FitTerm& term : terms)
        sums.add(color_sums(feature, *term.map, mesh.faces.size()), term.weight);
    fit_colors(mesh, sums, space, kPasses, levels, kept);
}

}  // namespace imgmesh
