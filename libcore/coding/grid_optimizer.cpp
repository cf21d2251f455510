#include "libcore/coding/grid_optimizer.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/index.h"
#include "libcore/coding/grid_schedule.h"
#include "libcore/coding/grid_state.h"

namespace imgmesh {
namespace {

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

GridOptimizer::GridOptimizer(const RowSums& sums, const CodedMesh& start, const OptimizeParams& params)
    : params_(params), state_(std::make_unique<GridState>(sums, start)) {
    state_->fit_colors(kFirstPasses);
}
GridOptimizer::~GridOptimizer() = default;

double GridOptimizer::squared_error() const {
    return state_->squared_error();
}
std::size_t GridOptimizer::vertices() const {
    return state_->vertices();
}
CodedMesh GridOptimizer::result() const {
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
    const bool surplus = state_->vertices() > vertices;
    while (state_->vertices() > vertices) {
        const auto most = static_cast<std::size_t>(
            std::ceil(kRemoved * static_cast<double>(state_->vertices() - vertices)));
        if (state_->remove_cheapest(most) == 0) break;
        state_->flip_edges();
    }
    if (surplus) settle(1);
}

void GridOptimizer::exchange(double share, int settles) {
    const std::size_t vertices = state_->vertices();
    state_->insert_best(static_cast<std::size_t>(std::ceil(share * static_cast<double>(vertices))));
    settle(settles);
    set_vertex_count(vertices);
}

void GridOptimizer::anneal(const GridSchedule& schedule) {
    GridRandom random(1);
    const int sweeps = static_cast<int>(
        std::clamp(schedule.sweeps * kUsualVertices / static_cast<double>(state_->vertices()),
                   schedule.sweeps * kLeastSweeps, schedule.sweeps * kMostSweeps));
    const double start =
        schedule.temperature * squared_error() / (2 * static_cast<double>(state_->vertices()));
    const Fall temperature(schedule.last_temperature, sweeps),
        spread(schedule.last_spread / schedule.spread, sweeps);
    for (int k = 0; k < sweeps; ++k) {
        state_->anneal(schedule.passes, schedule.trials, schedule.spread * spread.at(k),
                       start * temperature.at(k), random);
        state_->fit_colors(2);
    }
    settle(1);
}

void GridOptimizer::optimize() {
    optimize(grid_schedule(params_.effort));
}

void GridOptimizer::optimize(const GridSchedule& schedule) {
    const std::size_t vertices = state_->vertices();
    GridState best = *state_;
    const auto keep_if_better = [&] {
        if (state_->vertices() <= vertices && state_->squared_error() < best.squared_error()) best = *state_;
    };
    settle(schedule.settles);
    keep_if_better();
    for (int k = 0; k < schedule.rounds; ++k) {
        exchange(schedule.share, schedule.settles);
        keep_if_better();
    }
    if (schedule.sweeps > 0) {
        anneal(schedule);
        keep_if_better();
    }
    for (int k = 0; k < schedule.last_rounds; ++k) {
        exchange(schedule.last_share, schedule.settles);
        keep_if_better();
    }
    *state_ = best;
}

CodedMesh regular_mesh(const RowSums& sums, int step, std::size_t vertices) {
    CodedMesh mesh{{sums.width(), sums.height(), step}, sums.channels(), {}, {}, {}};
    const double along = std::sqrt(static_cast<double>(vertices) * sums.width() / sums.height());
    const int last_column = mesh.grid.columns() - 1, last_row = mesh.grid.rows() - 1;
    const int nx = std::clamp(static_cast<int>(along), 2, last_column + 1),
              ny = std::clamp(static_cast<int>(static_cast<double>(vertices) / along), 2, last_row + 1);
    for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x)
            mesh.point.push_back({x * last_column / (nx - 1), y * last_row / (ny - 1)});
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
