#include "libcore/warp/live_edits.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/warp/arap.h"
#include "libcore/warp/held_vertices.h"
#include "libcore/warp/injective.h"
#include "libcore/warp/ordered_mesh.h"

namespace imgmesh {
namespace {

// Of one step of a drag: an arap step on 1000 vertices takes 2 ms in a page.
constexpr int kArapSteps = 12, kInjectiveSteps = 12;
constexpr double kArapTolerance = 0.01;  // [pixels]

// The fixed vertices of a system and their moves, in the order of an OrderedMesh.
struct Fixed {
    std::vector<Id> ids;
    std::vector<Vec2d> moves;

    Fixed(const OrderedMesh& mesh, const HeldVertices& held) {
        std::vector<std::pair<Id, Id>> order;
        for (Id v = 0; v < held.held.size(); ++v)
            if (held.held[v]) order.emplace_back(mesh.rank[v], v);
        std::ranges::sort(order);
        for (const auto& [rank, v] : order) {
            ids.push_back(rank);
            moves.push_back(held.moves[v]);
        }
    }
};

// A factorised solver and what it found last.
template <typename Solver>
struct Warm {
    std::size_t level;
    std::vector<Id> ids;
    Solver solver;
    std::vector<Vec2d> asked;
    typename Solver::Result found;
    bool exact = false;  // whether `found` is what solve() gives
    bool used = true;    // in this call
};

template <typename Solver>
class WarmSolvers {
  public:
    // For the next edit with these vertices; several edits may have the same.
    Warm<Solver>& of(std::size_t level, const OrderedMesh& mesh, const Fixed& fixed) {
        const auto fits = [&](const Warm<Solver>& w) {
            return !w.used && w.level == level && w.ids == fixed.ids;
        };
        auto known = std::ranges::find_if(warm_, fits);
        if (known == warm_.end())
            known = warm_.insert(known, {level, fixed.ids, Solver(mesh.mesh, fixed.ids), {}, {}});
        known->used = true;
        return *known;
    }
    void begin() {
        for (Warm<Solver>& w : warm_) w.used = false;
    }
    void forget_unused() {
        std::erase_if(warm_, [](const Warm<Solver>& w) { return !w.used; });
    }

  private:
    std::vector<Warm<Solver>> warm_;
};

}  // namespace

struct LiveEdits::State {
    const MeshImage& mesh_image;
    std::vector<std::optional<OrderedMesh>> meshes = {};
    WarmSolvers<ArapSolver> rigid = {};
    WarmSolvers<InjectiveSolver> injective = {};

    const OrderedMesh& mesh(std::size_t level) {
        if (!meshes[level]) meshes[level] = ordered_mesh(mesh_image.levels[level].mesh);
        return *meshes[level];
    }
    void add_rigid(std::size_t level, const HeldVertices& held, bool live, std::vector<Vec2d>& sum);
    double add_injective(std::size_t level, const HeldVertices& held, bool live, std::vector<Vec2d>& sum);
    EditSolution solve(const WarpEdits& edits, bool live);
};

void LiveEdits::State::add_rigid(std::size_t level, const HeldVertices& held, bool live,
                                 std::vector<Vec2d>& sum) {
    const Fixed fixed(mesh(level), held);
    Warm<ArapSolver>& warm = rigid.of(level, mesh(level), fixed);
    if (!warm.exact || warm.asked != fixed.moves) {
        warm.found = live ? warm.solver.solve(fixed.moves, kArapTolerance, kArapSteps, warm.found.moves)
                          : warm.solver.solve(fixed.moves);
        warm.exact = !live;
        warm.asked = fixed.moves;
    }
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += warm.found.moves[mesh(level).rank[v]];
}

// Returns how far handles stay from their places.
double LiveEdits::State::add_injective(std::size_t level, const HeldVertices& held, bool live,
                                       std::vector<Vec2d>& sum) {
    const Fixed fixed(mesh(level), held);
    if (fixed.ids.empty()) return 0;
    Warm<InjectiveSolver>& warm = injective.of(level, mesh(level), fixed);
    if (!warm.exact || warm.asked != fixed.moves) {
        warm.found = live ? warm.solver.solve(fixed.moves, warm.found.moves, kInjectiveSteps)
                          : warm.solver.solve(fixed.moves);
        warm.exact = !live;
        warm.asked = fixed.moves;
    }
    for (std::size_t v = 0; v < sum.size(); ++v)
        sum[v] += warm.found.moves[mesh(level).rank[v]].cast<double>();
    return warm.found.left;
}

EditSolution LiveEdits::State::solve(const WarpEdits& edits, bool live) {
    const std::size_t levels = mesh_image.levels.size();
    meshes.resize(levels);
    rigid.begin();
    injective.begin();
    std::vector<std::vector<Vec2d>> sums;
    std::vector<HeldVertices> joint;  // what the injective edits of a level ask for together
    for (const Level& level : mesh_image.levels) {
        sums.emplace_back(level.mesh.vertex_count(), Vec2d(0, 0));
        joint.emplace_back(level.mesh.vertex_count());
    }
    for (const WarpEdit& edit : edits) {
        if (edit.level < 0 || edit.level >= as_int(levels))
            throw Error(ErrorKind::kBadFile,
                        cat(edit.where, ": level ", edit.level,
                            " is not there; the container has levels 0 to ", levels - 1));
        const auto level = as_index(edit.level);
        const HeldVertices held = held_vertices(mesh_image.levels[level].mesh, edit);
        if (edit.solver == WarpSolver::kInjective)
            joint[level].add(held);
        else if (edit.solver == WarpSolver::kArap)
            add_rigid(level, held, live, sums[level]);
        else
            for (std::size_t v = 0; v < held.moves.size(); ++v) sums[level][v] += held.moves[v];
    }
    EditSolution solution;
    solution.moves.resize(levels);
    for (std::size_t level = 0; level < levels; ++level) {
        solution.injective.push_back(std::ranges::count(joint[level].held, 1) > 0);
        solution.left.push_back(add_injective(level, joint[level], live, sums[level]));
        if (std::ranges::all_of(sums[level], [](const Vec2d& m) { return m.isZero(0); })) continue;
        for (const Vec2d& m : sums[level]) solution.moves[level].push_back(m.cast<float>());
    }
    rigid.forget_unused();
    injective.forget_unused();
    return solution;
}

LiveEdits::LiveEdits(const MeshImage& mesh_image) : state_(new State{mesh_image}) {}
LiveEdits::~LiveEdits() = default;
LiveEdits::LiveEdits(LiveEdits&&) noexcept = default;
LiveEdits& LiveEdits::operator=(LiveEdits&&) noexcept = default;

EditSolution LiveEdits::solve(const WarpEdits& edits) {
    return state_->solve(edits, false);
}

EditSolution LiveEdits::follow(const WarpEdits& edits) {
    return state_->solve(edits, true);
}

}  // namespace imgmesh
