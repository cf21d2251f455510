#include "libcore/warp/retarget.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/mesh/bounded_raster.h"
#include "libcore/mesh/trivial_map.h"

namespace imgmesh {
namespace {

// For one face: the gradients of its corners' hat functions [1 / pixel], and its area times its weight.
struct FaceEnergy {
    std::array<Vec2d, 3> gradient;
    double weight;
};

// How much more a face counts than an average one: the smaller it is, the more. Weights are averaged over the
// corners, so that single large faces inside detail do not give way. They are bounded, because the collapse
// leaves some slivers anywhere.
std::vector<double> importance(const BaseMesh& mesh, const std::vector<double>& area) {
    constexpr double kLeast = 0.02, kMost = 50;
    double total = 0;
    for (const double a : area) total += a;
    const double mean = total / double(area.size());
    std::vector<double> around(mesh.vertex_count(), 0.0), count(mesh.vertex_count(), 0.0);
    for (std::size_t f = 0; f < area.size(); ++f)
        for (const Id v : mesh.faces[f]) {
            around[v] += area[f];
            count[v] += 1;
        }
    std::vector<double> weight;
    for (const Face& face : mesh.faces) {
        double local = 0;
        for (const Id v : face) local += around[v] / count[v] / 3;
        const double density = mean / local;
        weight.push_back(std::clamp(density * density, kLeast, kMost));
    }
    return weight;
}

std::vector<FaceEnergy> energies(const BaseMesh& mesh) {
    std::vector<double> area;
    for (const auto& [a, b, c] : mesh.faces)
        area.push_back(signed_area2(mesh.position[a], mesh.position[b], mesh.position[c]) / 2);
    const std::vector<double> weight = importance(mesh, area);
    std::vector<FaceEnergy> all;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        FaceEnergy e;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2d p = mesh.position[mesh.faces[f][(k + 1) % 3]].cast<double>(),
                        q = mesh.position[mesh.faces[f][(k + 2) % 3]].cast<double>();
            // Across the opposite side, of length 1 / height; y grows down and faces run counter-clockwise.
            e.gradient[k] = Vec2d(q.y() - p.y(), p.x() - q.x()) / (2 * area[f]);
        }
        e.weight = weight[f] * area[f];
        all.push_back(e);
    }
    return all;
}

// One coordinate of the places. Some are given, the rest are solved for.
class Axis {
  public:
    // given[v] is its place, or NaN.
    Axis(const BaseMesh& mesh, const std::vector<FaceEnergy>& energy, std::vector<double> given)
        : mesh_(mesh), energy_(energy), place(std::move(given)), unknown_(mesh.vertex_count(), -1) {
        for (Id v = 0; v < place.size(); ++v)
            if (std::isnan(place[v])) unknown_[v] = as_int(count_++);
        std::vector<Eigen::Triplet<double>> entries;
        for_pairs([&](Id i, Id j, double value) {
            if (unknown_[i] >= 0 && unknown_[j] >= 0) entries.emplace_back(unknown_[i], unknown_[j], value);
        });
        Eigen::SparseMatrix<double> matrix(count_, count_);
        matrix.setFromTriplets(entries.begin(), entries.end());
        if (count_ > 0) factor_.compute(matrix);
        fixed_ = Eigen::VectorXd::Zero(count_);
        for_pairs([&](Id i, Id j, double value) {
            if (unknown_[i] >= 0 && unknown_[j] < 0) fixed_[unknown_[i]] -= value * place[j];
        });
    }

    // Finds the best places if the gradient in each face should be scale[f] along `axis`.
    void solve(const std::vector<double>& scale, int axis) {
        if (count_ == 0) return;
        Eigen::VectorXd right = fixed_;
        for (std::size_t f = 0; f < energy_.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k)
                if (const int i = unknown_[mesh_.faces[f][k]]; i >= 0)
                    right[i] += energy_[f].weight * scale[f] * energy_[f].gradient[k][axis];
        const Eigen::VectorXd found = factor_.solve(right);
        for (Id v = 0; v < place.size(); ++v)
            if (unknown_[v] >= 0) place[v] = found[unknown_[v]];
    }

    Vec2d gradient(std::size_t f) const {
        Vec2d sum(0, 0);
        for (std::size_t k = 0; k < 3; ++k) sum += place[mesh_.faces[f][k]] * energy_[f].gradient[k];
        return sum;
    }

  private:
    template <typename Visit>
    void for_pairs(const Visit& visit) const {
        for (std::size_t f = 0; f < energy_.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t l = 0; l < 3; ++l)
                    visit(mesh_.faces[f][k], mesh_.faces[f][l],
                          energy_[f].weight * energy_[f].gradient[k].dot(energy_[f].gradient[l]));
    }

    const BaseMesh& mesh_;
    const std::vector<FaceEnergy>& energy_;

  public:
    std::vector<double> place;

  private:
    std::vector<int> unknown_;
    Eigen::Index count_ = 0;
    Eigen::VectorXd fixed_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

// Where positions along an image's side lie on the drawing's.
double drawn(double at, int side, int size) {
    return (at + 0.5) * size / side - 0.5;
}

std::vector<double> side_places(const BaseMesh& mesh, int axis, int side, int size) {
    const float low = side > 1 ? 0 : -0.5f, high = side > 1 ? static_cast<float>(side - 1) : 0.5f;
    std::vector<double> given;
    for (const Vec2f& p : mesh.position)
        given.push_back(p[axis] <= low || p[axis] >= high ? drawn(double(p[axis]), side, size) : NAN);
    return given;
}

}  // namespace

VertexMoves retarget_moves(const BaseMesh& mesh, int width, int height, const OutputSize& size) {
    constexpr int kTurns = 30;  // of solving for the places and then for the scales
    // No face is asked to shrink below this share of uniform scaling: one asked to vanish may turn over.
    constexpr double kLeastScale = 0.05;
    // Faces below this share of their size under uniform scaling are as good as removed.
    constexpr double kLeastShare = 0.02;
    const std::vector<FaceEnergy> energy = energies(mesh);
    Axis x(mesh, energy, side_places(mesh, 0, width, size.width)),
        y(mesh, energy, side_places(mesh, 1, height, size.height));
    const double sx = double(size.width) / width, sy = double(size.height) / height;
    std::vector<double> scale(mesh.faces.size(), std::sqrt(sx * sy));
    for (int turn = 0; turn < kTurns; ++turn) {
        x.solve(scale, 0);
        y.solve(scale, 1);
        for (std::size_t f = 0; f < scale.size(); ++f)
            scale[f] =
                std::max(0.5 * (x.gradient(f).x() + y.gradient(f).y()), kLeastScale * std::min(sx, sy));
    }
    // Shrinks the moves towards uniform scaling until every face keeps an area.
    constexpr double kBack = 0.8, kGiveUp = 1e-3;  // some thirty shares; after these uniform scaling itself
    for (double share = 1;; share *= kBack) {
        VertexMoves moves;
        for (Id v = 0; v < mesh.vertex_count(); ++v) {
            const Vec2d p = mesh.position[v].cast<double>();
            const Vec2d to((x.place[v] + 0.5) / sx - 0.5, (y.place[v] + 0.5) / sy - 0.5);
            moves.push_back((share * (to - p)).cast<float>());
        }
        const bool keeps = std::all_of(mesh.faces.begin(), mesh.faces.end(), [&](const Face& face) {
            const auto at = [&](std::size_t k) { return Vec2f(mesh.position[face[k]] + moves[face[k]]); };
            return signed_area2(at(0), at(1), at(2)) >=
                   kLeastShare *
                       signed_area2(mesh.position[face[0]], mesh.position[face[1]], mesh.position[face[2]]);
        });
        if (keeps) return moves;
        if (share < kGiveUp) return VertexMoves(mesh.vertex_count(), Vec2f(0, 0));
    }
}

DisplacementField retarget_field(const MeshImage& mesh_image, const OutputSize& size) {
    const SourceInfo& source = mesh_image.source;
    if (source.has_mask)
        throw Error(ErrorKind::kUnsupported, "a masked image has no sides to give another size to");
    MeshImage by_place;
    by_place.source = source;
    by_place.levels.resize(1);
    Level& level = by_place.levels[0];
    level.mesh = mesh_image.levels[0].mesh;
    // Only where faces lie beside one another can the systems be factorised in bounded time, too.
    check_cover(level.mesh, sample_grid(source.width, source.height, 1));
    level.map = trivial_map(level.mesh, source.width, source.height);
    return displacement_field(by_place, {retarget_moves(level.mesh, source.width, source.height, size)});
}

void add_field(DisplacementField& sum, const DisplacementField& field) {
    for (std::size_t i = 0; i < sum.move.size(); ++i) sum.move[i] += field.move[i];
}

}  // namespace imgmesh
