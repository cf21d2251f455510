// Steps: (1) a quadric for every vertex; (2) edges are filed by the error that merging their ends would add;
// (3) the cheapest edge whose merge keeps the mesh a triangulation is collapsed, and the edges around it are
// filed anew; (4) until a limit is reached. Sources: paper sec. 3.1, 3.2; Garland and Heckbert 1997; Hoppe
// 1999.
#include "libcore/simplify/simplify.h"

#include <algorithm>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/image/channel_count.h"
#include "libcore/mesh/mesh_rings.h"
#include "libcore/simplify/kernel/simplifier.h"
#include "libcore/simplify/simplify_mesh.h"

namespace imgmesh {

// Compiled in simplifier_matrix.cpp.
extern template class Simplifier<MatrixQuadric<3>>;
extern template class Simplifier<MatrixQuadric<kAnyChannels>>;

namespace {

// The first channels of every item, or all and zeros behind them.
std::vector<float> with_channels(const std::vector<float>& values, int from, int to) {
    const std::size_t items = values.size() / static_cast<std::size_t>(from);
    std::vector<float> out(items * static_cast<std::size_t>(to), 0.0f);
    for (std::size_t i = 0; i < items; ++i)
        std::copy_n(values.data() + i * static_cast<std::size_t>(from), std::min(from, to),
                    out.data() + i * static_cast<std::size_t>(to));
    return out;
}

// For a grid whose features are fewer than the quadrics have room for.
template <class Q>
class PaddedSimplifier : public AnySimplifier {
  public:
    PaddedSimplifier(const GridMesh& grid, const SimplifyParams& params, const SimplifyHooks& hooks)
        : channels_(grid.feature.channels), wide_(padded(grid)), simplifier_(wide_, params, hooks) {}
    SimplifyResult to(const SimplifyTarget& target, const Progress& progress) override {
        SimplifyResult level = simplifier_.to(target, progress);
        level.mesh.channels = channels_;
        level.mesh.feature = with_channels(level.mesh.feature, Q::kChannels, channels_);
        return level;
    }

  private:
    static GridMesh padded(GridMesh grid) {
        grid.feature.data = with_channels(grid.feature.data, grid.feature.channels, Q::kChannels);
        grid.feature.channels = Q::kChannels;
        return grid;
    }

    int channels_;
    GridMesh wide_;
    Simplifier<Q> simplifier_;
};

template <class Q>
std::unique_ptr<AnySimplifier> simplifier_of(const GridMesh& grid, const SimplifyParams& params,
                                             const SimplifyHooks& hooks) {
    if constexpr (Q::kChannels != kAnyChannels)
        if (grid.feature.channels < Q::kChannels)
            return std::make_unique<PaddedSimplifier<Q>>(grid, params, hooks);
    return std::make_unique<Simplifier<Q>>(grid, params, hooks);
}

std::unique_ptr<AnySimplifier> make_simplifier(const GridMesh& grid, const SimplifyParams& params,
                                               const SimplifyHooks& hooks) {
    const int channels = grid.feature.channels;
    if (hooks.before && !grid.side_vertices.empty())
        throw Error(ErrorKind::kBadArgument, "a tile whose sides are given has no follower of its collapse");
    if (channels < 1 || channels > kMaxFeatures)
        throw Error(ErrorKind::kBadArgument, cat(channels, " features, expected 1 to ", kMaxFeatures));
    if (params.metric == Metric::kFlattened && params.solver == Solver::kClosed)
        return with_padded_features(
            channels, [&](auto padded) { return simplifier_of<Quadric<padded()>>(grid, params, hooks); });
    return channels <= 3 ? simplifier_of<MatrixQuadric<3>>(grid, params, hooks)
                         : simplifier_of<MatrixQuadric<kAnyChannels>>(grid, params, hooks);
}

const SimplifyHooks kNoHooks;

// A mesh whose vertices have the features of `mesh`, and its faces' quadrics.
template <class Q>
QuadricMesh<Q> quadric_mesh(const BaseMesh& mesh, RingMesh rings, float lambda) {
    const std::vector<float> features = with_channels(mesh.feature, mesh.channels, Q::kChannels);
    std::vector<Q> points(rings.size());
    for (std::size_t v = 0; v < rings.size(); ++v) {
        points[v].px = rings[v].x;
        points[v].py = rings[v].y;
        std::copy_n(features.data() + v * Q::kChannels, Q::kChannels, points[v].s);
    }
    std::vector<Q> quadrics = current_quadrics(rings, points, lambda);
    return {std::move(rings), std::move(quadrics), {}};
}

}  // namespace

SimplifyRun::SimplifyRun(const GridMesh& grid, const SimplifyParams& params)
    : simplifier_(make_simplifier(grid, params, kNoHooks)) {}
SimplifyRun::~SimplifyRun() = default;
SimplifyResult SimplifyRun::to(const SimplifyTarget& target, const Progress& progress) {
    return simplifier_->to(target, progress);
}

std::vector<SimplifyResult> simplify(const GridMesh& grid, const SimplifyParams& params,
                                     std::span<const SimplifyTarget> targets, const Progress& progress,
                                     const SimplifyHooks& hooks) {
    const std::unique_ptr<AnySimplifier> simplifier = make_simplifier(grid, params, hooks);
    std::vector<SimplifyResult> levels;
    for (const SimplifyTarget& target : targets) {
        levels.push_back(simplifier->to(target, progress));
        if (hooks.reached) hooks.reached(levels.size() - 1, levels.back());
    }
    return levels;
}

SimplifyResult simplify_mesh(const BaseMesh& mesh, const Vec2f& corner, const std::vector<Id>& side_vertices,
                             const SimplifyParams& params, const SimplifyTarget& target) {
    if (mesh.channels < 1 || mesh.channels > kMaxFeatures)
        throw Error(ErrorKind::kBadArgument, cat(mesh.channels, " features, expected 1 to ", kMaxFeatures));
    if (params.metric != Metric::kFlattened || params.solver != Solver::kClosed)
        throw Error(ErrorKind::kUnsupported, "a mesh is simplified by the first metric and solver alone");
    BaseMesh fitted = mesh;
    fit_for_rings(fitted);
    RingMesh rings = mesh_rings(fitted, corner);
    for (const Id v : side_vertices)
        if (rings[v].border()) rings[v].fixed = kFixedX | kFixedY;
    return with_padded_features(mesh.channels, [&](auto padded) {
        using Q = Quadric<padded()>;
        GridMesh frame;
        frame.feature = {
            static_cast<int>(corner.x()) + 1, static_cast<int>(corner.y()) + 1, Q::kChannels, {}};
        SimplifyResult result =
            Simplifier<Q>(frame, params, kNoHooks,
                          quadric_mesh<Q>(fitted, std::move(rings), params.geometry_weight))
                .to(target, {});
        result.mesh.channels = mesh.channels;
        result.mesh.feature = with_channels(result.mesh.feature, Q::kChannels, mesh.channels);
        return result;
    });
}

SimplifyResult simplify(const GridMesh& grid, const SimplifyParams& params, const SimplifyTarget& target,
                        const Progress& progress) {
    return std::move(simplify(grid, params, std::span(&target, 1), progress).front());
}

}  // namespace imgmesh
