// Source: Sorkine, Alexa, "As-Rigid-As-Possible Surface Modeling", SGP 2007. Minimises over places q and
// rotations R the energy
//     sum over edges ij of w_ij ( |q_i - q_j - R_i (p_i - p_j)|^2 + |q_j - q_i - R_j (p_j - p_i)|^2 )
// alternately: the best R for given q (in the plane, angles), then the best q for given R (Laplace equation).
#include "libcore/warp/arap.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <map>

namespace imgmesh {
namespace {

// Cotangent weights are negative across two obtuse angles, and then the energy may have no minimum. Any
// positive weights leave rigid motions free, so a small positive weight only makes such an edge soft. The
// weight of an edge between equilateral triangles is 0.58.
constexpr double kLeastWeight = 0.01;

struct Neighbor {
    Id vertex;
    double weight;
};

double cotangent_at(const Vec2f& apex, const Vec2f& a, const Vec2f& b) {
    const Vec2d u = (a - apex).cast<double>(), v = (b - apex).cast<double>();
    return u.dot(v) / std::abs(u.x() * v.y() - u.y() * v.x());
}

std::map<std::pair<Id, Id>, double> edge_weights(const BaseMesh& mesh) {
    std::map<std::pair<Id, Id>, double> weights;
    for (const Face& face : mesh.faces)
        for (std::size_t c = 0; c < 3; ++c) {
            const Id a = face[(c + 1) % 3], b = face[(c + 2) % 3];
            weights[std::minmax(a, b)] +=
                0.5 * cotangent_at(mesh.position[face[c]], mesh.position[a], mesh.position[b]);
        }
    for (auto& [edge, weight] : weights) weight = std::max(weight, kLeastWeight);
    return weights;
}

Vec2d turned(const Vec2d& rotation, const Vec2d& v) {
    return {rotation.x() * v.x() - rotation.y() * v.y(), rotation.y() * v.x() + rotation.x() * v.y()};
}

// The rotation (cos, sin) from a sum of dot products and a sum of cross products.
Vec2d rotation_of(double dot, double cross) {
    const double length =
        std::sqrt(dot * dot + cross * cross);  // not hypot(), which libraries round differently
    return length > 0 ? Vec2d(dot / length, cross / length) : Vec2d(1, 0);
}

}  // namespace

struct ArapSolver::State {
    std::vector<Vec2d> rest;
    std::vector<Id> fixed;
    std::vector<std::size_t> first;  // vertex v has the neighbours [first[v], first[v + 1])
    std::vector<Neighbor> neighbors;
    std::vector<Id> part, parts_fixed;  // connected part of each vertex, and of each fixed vertex
    Id part_count = 0;
    std::vector<Id> free;     // the vertices to solve for, ascending
    std::vector<Id> unknown;  // index in `free`, or kNone
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;

    void find_parts();
    void factorise();
    std::vector<Vec2d> rigid_guess(const std::vector<Vec2d>& moves) const;
    std::vector<Vec2d> rotations(const std::vector<Vec2d>& place) const;
    Eigen::MatrixX2d places(const std::vector<Vec2d>& place, const std::vector<Vec2d>& rotation) const;
};

void ArapSolver::State::find_parts() {
    part.assign(rest.size(), kNone);
    std::vector<Id> stack;
    for (Id seed = 0; seed < rest.size(); ++seed) {
        if (part[seed] != kNone) continue;
        part[seed] = part_count;
        stack.push_back(seed);
        while (!stack.empty()) {
            const Id v = stack.back();
            stack.pop_back();
            for (std::size_t k = first[v]; k < first[v + 1]; ++k) {
                const Id n = neighbors[k].vertex;
                if (part[n] != kNone) continue;
                part[n] = part_count;
                stack.push_back(n);
            }
        }
        ++part_count;
    }
}

void ArapSolver::State::factorise() {
    std::vector<bool> is_fixed(rest.size(), false), reached(part_count, false);
    for (const Id v : fixed) {
        is_fixed[v] = true;
        reached[part[v]] = true;
    }
    unknown.assign(rest.size(), kNone);
    for (Id v = 0; v < rest.size(); ++v) {
        if (is_fixed[v] || !reached[part[v]]) continue;
        unknown[v] = as_id(free.size());
        free.push_back(v);
    }
    if (free.empty()) return;
    std::vector<Eigen::Triplet<double>> entries;
    for (const Id v : free) {
        const int row = as_int(unknown[v]);
        double sum = 0;
        for (std::size_t k = first[v]; k < first[v + 1]; ++k) {
            sum += neighbors[k].weight;
            if (const Id column = unknown[neighbors[k].vertex]; column != kNone)
                entries.emplace_back(row, as_int(column), -neighbors[k].weight);
        }
        entries.emplace_back(row, row, sum);
    }
    const auto size = as_int(free.size());
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factor.compute(matrix);
}

// Moves every part rigidly, so that its fixed vertices are nearest to their places, then puts these there.
std::vector<Vec2d> ArapSolver::State::rigid_guess(const std::vector<Vec2d>& moves) const {
    struct Sums {
        double count = 0, dot = 0, cross = 0;
        Vec2d from{0, 0}, to{0, 0};
    };
    std::vector<Sums> sums(part_count);
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        Sums& s = sums[part[fixed[i]]];
        s.count += 1;
        s.from += rest[fixed[i]];
        s.to += rest[fixed[i]] + moves[i];
    }
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        Sums& s = sums[part[fixed[i]]];
        const Vec2d a = rest[fixed[i]] - s.from / s.count, b = rest[fixed[i]] + moves[i] - s.to / s.count;
        s.dot += a.dot(b);
        s.cross += a.x() * b.y() - a.y() * b.x();
    }
    std::vector<Vec2d> place = rest;
    for (const Id v : free) {
        const Sums& s = sums[part[v]];
        place[v] = s.to / s.count + turned(rotation_of(s.dot, s.cross), rest[v] - s.from / s.count);
    }
    for (std::size_t i = 0; i < fixed.size(); ++i) place[fixed[i]] = rest[fixed[i]] + moves[i];
    return place;
}

std::vector<Vec2d> ArapSolver::State::rotations(const std::vector<Vec2d>& place) const {
    std::vector<Vec2d> rotation(rest.size(), Vec2d(1, 0));
    for (Id v = 0; v < rest.size(); ++v) {
        double dot = 0, cross = 0;
        for (std::size_t k = first[v]; k < first[v + 1]; ++k) {
            const auto& [n, w] = neighbors[k];
            const Vec2d a = rest[v] - rest[n], b = place[v] - place[n];
            dot += w * a.dot(b);
            cross += w * (a.x() * b.y() - a.y() * b.x());
        }
        rotation[v] = rotation_of(dot, cross);
    }
    return rotation;
}

// Finds the best places of the free vertices for given rotations.
Eigen::MatrixX2d ArapSolver::State::places(const std::vector<Vec2d>& place,
                                           const std::vector<Vec2d>& rotation) const {
    Eigen::MatrixX2d right(as_int(free.size()), 2);
    for (std::size_t i = 0; i < free.size(); ++i) {
        const Id v = free[i];
        Vec2d sum(0, 0);
        for (std::size_t k = first[v]; k < first[v + 1]; ++k) {
            const auto& [n, w] = neighbors[k];
            sum += 0.5 * w * turned(rotation[v] + rotation[n], rest[v] - rest[n]);
            if (unknown[n] == kNone) sum += w * place[n];
        }
        right.row(static_cast<Eigen::Index>(i)) = sum.transpose();
    }
    return factor.solve(right);
}

ArapSolver::ArapSolver(const BaseMesh& mesh, const std::vector<Id>& fixed)
    : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.fixed = fixed;
    for (const Vec2f& p : mesh.position) s.rest.push_back(p.cast<double>());
    const auto weights = edge_weights(mesh);
    s.first.assign(s.rest.size() + 1, 0);
    for (const auto& [edge, weight] : weights) {
        ++s.first[edge.first + 1];
        ++s.first[edge.second + 1];
    }
    for (std::size_t v = 0; v < s.rest.size(); ++v) s.first[v + 1] += s.first[v];
    s.neighbors.resize(2 * weights.size());
    std::vector<std::size_t> next(s.first.begin(), s.first.end() - 1);
    for (const auto& [edge, weight] : weights) {
        s.neighbors[next[edge.first]++] = {edge.second, weight};
        s.neighbors[next[edge.second]++] = {edge.first, weight};
    }
    s.find_parts();
    s.factorise();
}
ArapSolver::~ArapSolver() = default;
ArapSolver::ArapSolver(ArapSolver&&) noexcept = default;
ArapSolver& ArapSolver::operator=(ArapSolver&&) noexcept = default;

ArapSolver::Result ArapSolver::solve(const std::vector<Vec2d>& moves, double tolerance, int max_iterations,
                                     const std::vector<Vec2d>& start) const {
    const State& s = *state_;
    Result result;
    result.moves.assign(s.rest.size(), Vec2d(0, 0));
    const bool equal =
        std::all_of(moves.begin(), moves.end(), [&](const Vec2d& m) { return m == moves.front(); });
    if (equal && !moves.empty()) {
        for (const Id v : s.free) result.moves[v] = moves.front();
    } else {
        std::vector<Vec2d> place = s.rigid_guess(moves);
        if (start.size() == place.size())
            for (const Id v : s.free) place[v] = s.rest[v] + start[v];
        double change = tolerance + 1;
        for (; !s.free.empty() && change > tolerance && result.iterations < max_iterations;
             ++result.iterations) {
            const Eigen::MatrixX2d found = s.places(place, s.rotations(place));
            change = 0;
            for (std::size_t i = 0; i < s.free.size(); ++i) {
                const Vec2d to = found.row(static_cast<Eigen::Index>(i)).transpose();
                change = std::max(change, (to - place[s.free[i]]).lpNorm<Eigen::Infinity>());
                place[s.free[i]] = to;
            }
        }
        for (const Id v : s.free) result.moves[v] = place[v] - s.rest[v];
    }
    for (std::size_t i = 0; i < moves.size(); ++i) result.moves[s.fixed[i]] = moves[i];
    return result;
}

}  // namespace imgmesh
