#include "libcore/optimize/grid_optimizer.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "libcore/base/index.h"
#include "libcore/mesh/fixed_axes.h"
#include "libcore/optimize/grid_schedule.h"
#include "libcore/optimize/grid_state.h"

namespace imgmesh {
namespace {

constexpr std::string_view kStage = "refine";
// Colours of a new mesh start far from their best.
constexpr int kFirstPasses = 12;
// Of Gauss-Seidel between other steps.
constexpr int kPasses = 6;
// A mesh grows by this share at most before it settles: what gains most depends on what is there.
constexpr double kGrowth = 0.5;
// Of a surplus of vertices this share goes at once: each removal changes the costs of others.
constexpr double kRemoved = 0.35;

// A schedule's sweeps are for so many vertices: fewer get more of them, and more get fewer, within these
// factors.
constexpr double kUsualVertices = 2000, kMostSweeps = 8, kLeastSweeps = 0.5;

// The part of a geometric fall from 1 to `last` after each of `steps`, as a factor. By square roots, which
// are the same everywhere.
class Fall {
  public:
    Fall(double last, int steps) : last_(last), steps_(steps) {}
    double at(int step) const {
        // Bisection of the exponent: last^(step / steps).
        double value = 1, factor = last_, share = static_cast<double>(step) / steps_;
        for (int bit = 0; bit < 24; ++bit) {
            factor = std::sqrt(factor);
            share *= 2;
            if (share < 1) continue;
            share -= 1;
            value *= factor;
        }
        return value;
    }

  private:
    double last_;
    int steps_;
};

}  // namespace

GridOptimizer::GridOptimizer(const RowSums& sums, const PlacedMesh& start, const OptimizeParams& params)
    : params_(params),
      state_(std::make_unique<GridState>(sums, start, PlaceGrid{sums.width(), sums.height(), params.step},
                                         FaceRules(params.limits, 0))) {
    state_->set_pattern(params.longest_step, params.first_step);
    if (params.newton_steps) state_->use_newton_steps();
    state_->reorder();
    state_->fit_colors(kFirstPasses);
    border_ = state_->border_vertices();
    if (params.shape_weight > 0) {
        const double unit =
            params.shape_weight * state_->squared_error() / static_cast<double>(state_->faces());
        state_->set_rules(FaceRules(params.limits, unit));
    }
}
GridOptimizer::~GridOptimizer() = default;

double GridOptimizer::cost() const {
    return state_->cost();
}
double GridOptimizer::squared_error() const {
    return state_->squared_error();
}
std::size_t GridOptimizer::vertices() const {
    return state_->vertices();
}
PlacedMesh GridOptimizer::result() const {
    return state_->result();
}

void GridOptimizer::settle(int times) {
    state_->reorder();
    for (int k = 0; k < times; ++k) {
        state_->flip_and_move();
        state_->fit_colors(kPasses);
    }
}

void GridOptimizer::set_vertex_count(std::size_t vertices) {
    while (state_->vertices() < vertices) {
        const std::size_t now = state_->vertices();
        const auto most =
            std::max<std::size_t>(4, static_cast<std::size_t>(kGrowth * static_cast<double>(now)));
        if (state_->insert_best(std::min(vertices - now, most)) == 0) break;
        settle(2);
    }
    if (state_->vertices() > vertices) remove_surplus(vertices);
}

void GridOptimizer::remove_surplus(std::size_t vertices) {
    while (state_->vertices() > vertices) {
        const std::size_t surplus = state_->vertices() - vertices;
        const auto most = static_cast<std::size_t>(std::ceil(kRemoved * static_cast<double>(surplus)));
        const std::size_t border = params_.keep_faces ? state_->border_vertices() - border_ : most,
                          inner = params_.keep_faces ? surplus - border : most;
        if (state_->remove_cheapest(most, border, inner) == 0) break;
        state_->flip_edges();
    }
    settle(params_.last_settles);
}

void GridOptimizer::exchange(std::size_t vertices, double share, int settles) {
    state_->insert_best(static_cast<std::size_t>(std::ceil(share * static_cast<double>(vertices))));
    settle(settles);
    set_vertex_count(vertices);
}

void GridOptimizer::anneal(const GridSchedule& schedule, const Progress& progress, double begin, double end) {
    GridRandom random(1);
    const int sweeps = static_cast<int>(
        std::clamp(schedule.sweeps * kUsualVertices / static_cast<double>(state_->vertices()),
                   schedule.sweeps * kLeastSweeps, schedule.sweeps * kMostSweeps));
    const double start = schedule.temperature * cost() / (2 * static_cast<double>(state_->vertices()));
    const Fall temperature(schedule.last_temperature, sweeps),
        spread(schedule.last_spread / schedule.spread, sweeps);
    for (int k = 0; k < sweeps; ++k) {
        if (progress) progress(begin + (end - begin) * k / sweeps, kStage);
        state_->anneal(schedule.passes, schedule.trials, schedule.spread * spread.at(k),
                       start * temperature.at(k), random.next());
        state_->fit_colors(2);
    }
    settle(1);
}

void GridOptimizer::optimize() {
    optimize(grid_schedule(params_.effort));
}

void GridOptimizer::optimize(const GridSchedule& schedule, const Progress& progress) {
    const std::size_t vertices = state_->vertices();
    // In rounds; an anneal of the usual length takes about as long as four.
    const double anneal_rounds = 0.1 * schedule.sweeps,
                 rounds = schedule.rounds + anneal_rounds + schedule.last_rounds;
    double done = 0;
    const auto share_done = [&] { return done / std::max(rounds, 1.0); };
    GridState best = *state_;
    const auto keep_if_better = [&] {
        if (state_->vertices() == vertices && state_->cost() < best.cost()) best = *state_;
    };
    const auto exchanges = [&](int count, double share) {
        for (int k = 0; k < count; ++k, ++done) {
            if (progress) progress(share_done(), kStage);
            exchange(vertices, share, schedule.settles);
            keep_if_better();
        }
    };
    settle(schedule.settles);
    keep_if_better();
    exchanges(schedule.rounds, schedule.share);
    if (schedule.sweeps > 0) {
        const double begin = share_done();
        done += anneal_rounds;
        anneal(schedule, progress, begin, share_done());
        keep_if_better();
    }
    exchanges(schedule.last_rounds, schedule.last_share);
    *state_ = best;
}

PlacedMesh regular_mesh(const RowSums& sums, int step, std::size_t vertices) {
    PlacedMesh mesh;
    const PlaceGrid grid{sums.width(), sums.height(), step};
    const double along = std::sqrt(static_cast<double>(vertices) * sums.width() / sums.height());
    const int last_column = grid.columns() - 1, last_row = grid.rows() - 1;
    const int nx = std::clamp(static_cast<int>(along), 2, last_column + 1),
              ny = std::clamp(static_cast<int>(static_cast<double>(vertices) / along), 2, last_row + 1);
    for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
            mesh.spot.push_back({{grid.x(x * last_column / (nx - 1)), grid.y(y * last_row / (ny - 1))}});
            mesh.fixed.push_back(static_cast<std::uint8_t>((x == 0 || x == nx - 1 ? kFixedX : 0) |
                                                           (y == 0 || y == ny - 1 ? kFixedY : 0)));
        }
    for (int y = 0; y + 1 < ny; ++y)
        for (int x = 0; x + 1 < nx; ++x) {
            const Id a = as_id(y * nx + x), b = as_id(a + as_id(nx)), c = b + 1, d = a + 1;
            // Diagonals alternate, so that no direction is preferred.
            if ((x + y) % 2 == 0) {
                mesh.faces.push_back({a, b, c});
                mesh.faces.push_back({a, c, d});
            } else {
                mesh.faces.push_back({a, b, d});
                mesh.faces.push_back({b, c, d});
            }
        }
    return mesh;
}

}  // namespace imgmesh
