// Steps of solve():
//  1. Guess: move rigidly, put the fixed vertices at their places, let the others follow like a rigid body.
//  2. Untangle: unfold faces with the fixed vertices where they are (face_energy.h). Most guesses unfold.
//  3. Follow: if not, start without folds and pull the fixed vertices as far as no face turns over.
//  4. Relax: minimise the energy that is infinite for a face without area, by steps that turn none over.
//  5. Round: to positions that a container can hold, and compare areas exactly (round_moves.h).
#include "libcore/warp/injective.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "libcore/warp/face_descent.h"
#include "libcore/warp/face_energy.h"
#include "libcore/warp/laplace_factor.h"
#include "libcore/warp/mesh_parts.h"
#include "libcore/warp/round_moves.h"

namespace imgmesh {
namespace {

// Of the energy's Hessian at rest, 2 for turning and 8 for stretching, in units of the Laplacian.
constexpr double kStiffness = 4;

std::vector<bool> without(std::vector<bool> all, const std::vector<Id>& some) {
    for (const Id v : some) all[v] = false;
    return all;
}

}  // namespace

struct InjectiveSolver::State {
    State(const BaseMesh& base, const std::vector<Id>& ids);

    // One call of solve().
    struct Search {
        const std::vector<Vec2d>& moves;
        std::vector<Vec2d> target;  // of the fixed vertices
        std::vector<Vec2d> place;   // of all vertices
        int steps = 0;
    };

    Result solve(const std::vector<Vec2d>& moves, const std::vector<Vec2f>& start, int max_iterations) const;
    void guess(Search& search, int most_steps) const;
    void extend(Search& search) const;
    bool untangle(Search& search, int most_steps) const;
    void follow(Search& search, int most_steps) const;
    void approach(Search& search, int most_steps) const;
    void relax(Search& search, int most_steps) const;
    bool round(const Search& search, std::vector<Vec2f>& moves) const;
    bool is_there(const Search& search) const;

    BaseMesh mesh;  // positions and faces only
    std::vector<Vec2d> rest;
    std::vector<Id> fixed;
    MeshParts parts;
    std::vector<bool> used, is_free;
    FaceEnergies energies;
    LaplaceFactor factor;
};

InjectiveSolver::State::State(const BaseMesh& base, const std::vector<Id>& ids)
    : mesh{base.channels, base.position, {}, base.faces},
      fixed(ids),
      parts(base),
      used(parts.vertices_with(ids)),
      is_free(without(used, ids)),
      energies(base, used),
      factor(energies, is_free, kStiffness) {
    for (const Vec2f& p : mesh.position) rest.push_back(p.cast<double>());
}

void InjectiveSolver::State::guess(Search& search, int most_steps) const {
    constexpr int kSteps = 12;
    parts.move_rigidly(rest, fixed, search.target, search.place);
    FaceDescent descent(energies, factor, search.place);
    descent.restart({EnergyKind::Form::kRigid});
    const int last = search.steps + std::min(kSteps, most_steps);
    while (search.steps < last && descent.step() > 0) ++search.steps;
}

// Puts the fixed vertices at their places and moves the others harmonically along.
void InjectiveSolver::State::extend(Search& search) const {
    std::vector<Vec2d> move(rest.size(), Vec2d(0, 0));
    for (std::size_t i = 0; i < fixed.size(); ++i) move[fixed[i]] = search.target[i] - search.place[fixed[i]];
    factor.extend(move);
    for (const Id v : factor.free()) search.place[v] += move[v];
    for (std::size_t i = 0; i < fixed.size(); ++i) search.place[fixed[i]] = search.target[i];
}

// Unfolds the faces with the fixed vertices where they are. Returns whether it came to that. The energy is
// the smoother the more the worst face is turned over, as Garanzha et al. propose.
bool InjectiveSolver::State::untangle(Search& search, int most_steps) const {
    constexpr double kLeast = 5e-3, kShare = 0.2;
    // The cheap method unfolds most meshes within as many steps; what then still is folded is stiff, and
    // takes Newton's.
    constexpr int kCheap = 90, kSameEnergy = 30;
    FaceDescent descent(energies, factor, search.place);
    std::optional<HessianFactor> newton;
    double least = energies.least_determinant(search.place);
    for (int i = 0; !(least > 0); ++i, ++search.steps) {
        if (i >= most_steps) return false;
        if (i == kCheap) newton.emplace(energies, rest.size(), factor.free());
        if (newton || i % kSameEnergy == 0)
            descent.restart(
                {EnergyKind::Form::kUntangle, std::sqrt(kLeast * kLeast + kShare * kShare * least * least)});
        if (!((newton ? descent.step(*newton) : descent.step()) > 0)) return false;
        least = energies.least_determinant(search.place);
    }
    return true;
}

// Moves the fixed vertices straight towards their places. Each turn goes a share of the way to where the
// first face would turn over, and then lets the mesh give way.
void InjectiveSolver::State::follow(Search& search, int most_steps) const {
    constexpr double kShare = 0.6;
    constexpr double kStuck = 1e-3;  // of the way that is left
    // Of what a face has at rest. With less, there may be no room to round.
    constexpr double kLeastArea = 0.05;
    constexpr int kRelaxing = 4, kPatience = 3;
    const int last = search.steps + most_steps;
    for (int stuck = 0; search.steps < last && stuck < kPatience; ++search.steps) {
        const std::vector<Vec2d> from = search.place;
        extend(search);
        std::vector<Vec2d> move;
        for (std::size_t v = 0; v < from.size(); ++v) move.push_back(search.place[v] - from[v]);
        const double most = energies.largest_step(from, move);
        if (!(most < 1)) return;
        const double least = std::min(kLeastArea, energies.least_determinant(from));
        double share = kShare * most;
        const auto go = [&] {
            for (std::size_t v = 0; v < from.size(); ++v) search.place[v] = from[v] + share * move[v];
        };
        for (go(); share > kStuck && energies.least_determinant(search.place) < least; go()) share /= 2;
        stuck = share <= kStuck ? stuck + 1 : 0;
        relax(search, std::min(kRelaxing, last - search.steps));
    }
}

// Follows with all fixed vertices, and where that ends, with one after the other: those whose way is free are
// not to stay behind with those whose way is barred.
void InjectiveSolver::State::approach(Search& search, int most_steps) const {
    constexpr int kMostForOne = 40;
    const int last = search.steps + most_steps;
    follow(search, most_steps / 2);
    const std::vector<Vec2d> target = search.target;
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        if (search.place[fixed[i]] == target[i]) continue;
        for (std::size_t k = 0; k < fixed.size(); ++k) search.target[k] = search.place[fixed[k]];
        search.target[i] = target[i];
        follow(search, std::min(kMostForOne, last - search.steps));
    }
    search.target = target;
}

void InjectiveSolver::State::relax(Search& search, int most_steps) const {
    constexpr double kEnough = 1e-5;  // of the energy
    constexpr double kStill = 0.01;   // [pixels]
    FaceDescent descent(energies, factor, search.place);
    descent.restart({EnergyKind::Form::kBarrier});
    for (int i = 0; i < most_steps; ++i, ++search.steps) {
        const double before = descent.energy(), moved = descent.step();
        if (moved < kStill || before - descent.energy() < kEnough * before) return;
    }
}

// Where a vertex is at its target, it has exactly the move that was asked for; where all moves of a part are
// equal, the whole part has.
bool InjectiveSolver::State::round(const Search& search, std::vector<Vec2f>& moves) const {
    std::vector<const Vec2d*> of_part(parts.count(), nullptr);
    std::vector<bool> differ(parts.count(), false);
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        const Vec2d& at = search.place[fixed[i]];
        moves[fixed[i]] =
            (at == search.target[i] ? search.moves[i] : Vec2d(at - rest[fixed[i]])).cast<float>();
        const Vec2d*& first = of_part[parts.of(fixed[i])];
        if (!first) first = &search.moves[i];
        if (*first != search.moves[i] || at != search.target[i]) differ[parts.of(fixed[i])] = true;
    }
    std::vector<bool> open = is_free;
    for (const Id v : factor.free()) {
        if (differ[parts.of(v)]) continue;
        moves[v] = of_part[parts.of(v)]->cast<float>();
        open[v] = false;
    }
    return round_moves(mesh, used, open, search.place, moves) ||
           round_moves(mesh, used, is_free, search.place, moves);
}

bool InjectiveSolver::State::is_there(const Search& search) const {
    for (std::size_t i = 0; i < fixed.size(); ++i)
        if (search.place[fixed[i]] != search.target[i]) return false;
    return true;
}

InjectiveSolver::Result InjectiveSolver::State::solve(const std::vector<Vec2d>& moves,
                                                      const std::vector<Vec2f>& start,
                                                      int max_iterations) const {
    constexpr int kMostRelaxing = 120;
    Search search{moves, {}, rest};
    for (std::size_t i = 0; i < fixed.size(); ++i) search.target.push_back(rest[fixed[i]] + moves[i]);
    Result result;
    result.moves.assign(rest.size(), Vec2f(0, 0));
    const bool is_warm = start.size() == rest.size() && keeps_faces(mesh, used, start);
    if (is_warm)
        for (Id v = 0; v < rest.size(); ++v)
            if (used[v]) search.place[v] += start[v].cast<double>();
    const std::vector<Vec2d> safe = search.place;

    // A start unfolds fast or not at all. A guess from the mesh at rest may still find what it does not, but
    // not within the few steps of a drag.
    constexpr int kWorthGuessing = 100;
    const bool guesses = !is_warm || max_iterations >= kWorthGuessing;
    bool found = is_there(search);
    if (!found && is_warm) {
        extend(search);
        found = untangle(search, max_iterations / (guesses ? 4 : 2));
    }
    if (!found && guesses) {
        guess(search, max_iterations / 2 - search.steps);
        found = untangle(search, max_iterations / 2 - search.steps);
    }
    if (!found) {
        search.place = safe;
        approach(search, (max_iterations - search.steps) * 3 / 4);
    }
    relax(search, std::min(kMostRelaxing, max_iterations - search.steps));
    // There may be no room to round where faces are pressed together.
    constexpr double kBack = 0.5;
    for (double share = 1; !round(search, result.moves) && share > 0;) {
        share = share > 0.1 ? kBack * share : 0;
        for (std::size_t v = 0; v < safe.size(); ++v)
            search.place[v] = safe[v] + share * (search.place[v] - safe[v]);
    }
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        const Vec2f asked = moves[i].cast<float>(), done = result.moves[fixed[i]];
        if (done != asked) result.left = std::max(result.left, (done.cast<double>() - moves[i]).norm());
    }
    result.iterations = search.steps;
    return result;
}

InjectiveSolver::InjectiveSolver(const BaseMesh& mesh, const std::vector<Id>& fixed)
    : state_(std::make_unique<State>(mesh, fixed)) {}
InjectiveSolver::~InjectiveSolver() = default;
InjectiveSolver::InjectiveSolver(InjectiveSolver&&) noexcept = default;
InjectiveSolver& InjectiveSolver::operator=(InjectiveSolver&&) noexcept = default;

InjectiveSolver::Result InjectiveSolver::solve(const std::vector<Vec2d>& moves,
                                               const std::vector<Vec2f>& start, int max_iterations) const {
    return state_->solve(moves, start, max_iterations);
}

}  // namespace imgmesh
