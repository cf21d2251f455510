// Moves of vertices on the grid: pattern search, and random moves.
#include <algorithm>
#include <cmath>

#include "libcore/mesh/fixed_axes.h"
#include "libcore/optimize/grid_state.h"

namespace imgmesh {
namespace {

constexpr std::int32_t kDirections[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                            {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
// Gains within the rounding of the sums do not count.
constexpr double kSlack = 1e-9;

}  // namespace

bool GridState::may_move(Id v, OneRing& ring, const Worker& worker) const {
    if (!mesh_.live_vertex(v) || keeps_place(vertex_[v].fixed) || !mesh_.ring(v, ring)) return false;
    return std::all_of(ring.vertex.begin(), ring.vertex.begin() + static_cast<std::ptrdiff_t>(ring.faces + 1),
                       [&](Id u) { return worker.claims(u); });
}

void GridState::fan_of(const OneRing& ring, Fan& fan) const {
    fan.faces = ring.faces;
    fan.closed = ring.closed;
    for (std::size_t k = 0; k <= ring.faces; ++k) fan.spot[k] = spot_[ring.vertex[k]];
    fan.measure_links(*sums_);
}

double GridState::cost_of(const OneRing& ring) const {
    double cost = 0;
    for (std::size_t k = 0; k < ring.faces; ++k) cost += cost_[ring.face[k]];
    return cost;
}

bool GridState::try_place(const Fan& fan, Id v, std::int32_t column, std::int32_t row, FanFit& fit) const {
    if (column < 0 || row < 0 || column >= grid_.columns() || row >= grid_.rows()) return false;
    const std::uint8_t fixed = vertex_[v].fixed;
    if ((column != vertex_[v].column && (fixed & kFixedX)) || (row != vertex_[v].row && (fixed & kFixedY)))
        return false;
    const Place at = place(column, row);
    if (!rules_.admits(fan, at, fit)) return false;
    fit_admitted(fan, at, spot_[v].color, fit);
    return true;
}

void GridState::fit_admitted(const Fan& fan, const Place& at, const Double4& color, FanFit& fit) const {
    fit_fan(*sums_, fan, at, color, fit);
    if (rules_.limits_colors()) fit.set_color(rules_.allowed(fit.color));
}

void GridState::set(const OneRing& ring, std::int32_t column, std::int32_t row, const FanFit& fit,
                    Worker& worker) {
    Vertex& vertex = vertex_[ring.center];
    vertex.column = column;
    vertex.row = row;
    spot_[ring.center] = {fit.place, fit.color};
    vertex.removal_holds = false;
    for (std::size_t k = 0; k < ring.faces; ++k) {
        cost_[ring.face[k]] = fit.face_cost(k);
        changed_[ring.face[k]] = ++worker.tick;
        vertex_[ring.vertex[k]].removal_holds = false;
    }
    vertex_[ring.vertex[ring.faces]].removal_holds = false;
}

double GridState::step_to_minimum(Id v, const OneRing& ring, const Fan& fan, double best, Worker& worker) {
    constexpr int kHalvings = 2;
    const std::int32_t column = vertex_[v].column, row = vertex_[v].row;
    FanFit fit;
    const auto take_if_better = [&](std::int32_t dx, std::int32_t dy) {
        if (!try_place(fan, v, column + dx, row + dy, fit) || !(fit.error < best)) return false;
        set(ring, column + dx, row + dy, fit, worker);
        best = fit.error - kSlack * fit.error;
        return true;
    };
    // In its best colour here; a vertex off the grid stays on its place for that.
    if (!rules_.admits(fan, spot_[v].place, fit)) return best;
    fit_admitted(fan, spot_[v].place, spot_[v].color, fit);
    const FanStep step = newton_step(fan, fit, vertex_[v].fixed);
    const double length = std::sqrt(step.x * step.x + step.y * step.y), longest = 0.5 * fan.reach(fit.place);
    if (!(length > 0 && length < 1e9)) return best;
    double scale = std::min(1.0, longest / length) / grid_.step;
    for (int half = 0; half <= kHalvings; ++half, scale *= 0.5)
        if (take_if_better(static_cast<std::int32_t>(std::lround(scale * step.x)),
                           static_cast<std::int32_t>(std::lround(scale * step.y))))
            break;
    return best;
}

void GridState::move_vertex(Id v, Worker& worker) {
    OneRing ring;
    Fan fan;
    if (!may_move(v, ring, worker)) return;
    fan_of(ring, fan);
    FanFit fit;
    double best = cost_of(ring);
    best -= kSlack * best;
    if (newton_) best = step_to_minimum(v, ring, fan, best, worker);
    bool moved = false;
    const std::uint8_t first = vertex_[v].direction;
    const std::int32_t step = vertex_[v].step;
    for (std::uint8_t n = 0; n < 8; ++n) {
        const auto direction = static_cast<std::uint8_t>((first + n) % 8);
        const std::int32_t dx = step * kDirections[direction][0], dy = step * kDirections[direction][1];
        // A step that succeeds is repeated.
        while (try_place(fan, v, vertex_[v].column + dx, vertex_[v].row + dy, fit) && fit.error < best) {
            set(ring, vertex_[v].column + dx, vertex_[v].row + dy, fit, worker);
            vertex_[v].direction = direction;
            best = fit.error - kSlack * fit.error;
            moved = true;
        }
    }
    vertex_[v].step =
        static_cast<std::uint8_t>(moved ? std::min(2 * step, longest_step_) : std::max(step / 2, 1));
}

void GridState::anneal_vertex(Id v, int trials, double spread, double temperature, Worker& worker) {
    OneRing ring;
    Fan fan;
    if (!may_move(v, ring, worker)) return;
    fan_of(ring, fan);
    GridRandom& random = worker.random;
    FanFit fit;
    double now = cost_of(ring);
    for (int trial = 0; trial < trials; ++trial) {
        std::int32_t dx = static_cast<std::int32_t>(std::lround(spread * random.gaussian())),
                     dy = static_cast<std::int32_t>(std::lround(spread * random.gaussian()));
        if (dx == 0 && dy == 0) {
            const auto& direction = kDirections[random.next() % 8];
            dx = direction[0];
            dy = direction[1];
        }
        const double allowed = temperature * random.exponential();
        const std::int32_t column = vertex_[v].column + dx, row = vertex_[v].row + dy;
        if (!try_place(fan, v, column, row, fit) || !(fit.error - now < allowed)) continue;
        set(ring, column, row, fit, worker);
        now = fit.error;
    }
}

// Parts that lie together, one after the other, are worked on while caches hold their pixels.
template <class Work>
void GridState::for_each_part(std::uint64_t seed, Work&& work) {
    constexpr Id kPartVertices = 24;
    const GridTiles tiles(mesh_.faces(), vertex_.size());
    std::vector<std::uint64_t> ticks(tiles.size(), 0);
    tiles.for_each(
        [&](const Turn& turn) {
            Worker worker{&turn, tick_, GridRandom(GridRandom(seed + turn.tile).next())};
            for (Id first = turn.first; first < turn.last; first += kPartVertices)
                work(first, std::min(first + kPartVertices, turn.last), worker);
            ticks[turn.tile] = worker.tick;
        },
        [&] { tick_ = std::max(tick_, *std::max_element(ticks.begin(), ticks.end())); });
}

void GridState::flip_edges() {
    for_each_part(0, [&](Id first, Id last, Worker& worker) {
        for (Id v = first; v < last; ++v) flip_edges(v, worker);
    });
}

void GridState::flip_and_move() {
    for_each_part(0, [&](Id first, Id last, Worker& worker) {
        for (Id v = first; v < last; ++v) flip_edges(v, worker);
        for (Id v = first; v < last; ++v) move_vertex(v, worker);
    });
}

void GridState::anneal(int passes, int trials, double spread, double temperature, std::uint64_t seed) {
    for_each_part(seed, [&](Id first, Id last, Worker& worker) {
        for (int pass = 0; pass < passes; ++pass) {
            for (Id v = first; v < last; ++v) anneal_vertex(v, trials, spread, temperature, worker);
            for (Id v = first; v < last; ++v) anneal_flips(v, temperature, worker);
        }
    });
}

}  // namespace imgmesh
