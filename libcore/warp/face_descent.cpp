#include "libcore/warp/face_descent.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace imgmesh {
namespace {

constexpr std::size_t kPairs = 6;

// In an order that does not depend on the compiler: four sums, each of every fourth product.
double product(std::span<const Vec2d> a, std::span<const Vec2d> b) {
    std::array<double, 4> sum{};
    std::size_t i = 0;
    for (; i + 2 <= a.size(); i += 2) {
        sum[0] += a[i].x() * b[i].x();
        sum[1] += a[i].y() * b[i].y();
        sum[2] += a[i + 1].x() * b[i + 1].x();
        sum[3] += a[i + 1].y() * b[i + 1].y();
    }
    if (i < a.size()) {
        sum[0] += a[i].x() * b[i].x();
        sum[1] += a[i].y() * b[i].y();
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

void add(std::span<Vec2d> to, double factor, std::span<const Vec2d> what) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * what[i];
}

}  // namespace

FaceDescent::FaceDescent(const FaceEnergies& energies, const LaplaceFactor& factor, std::vector<Vec2d>& place)
    : energies_(energies),
      factor_(factor),
      place_(place),
      pairs_(kPairs),
      slope_(place.size()),
      new_slope_(place.size()),
      direction_(factor.free().size()),
      move_(place.size(), Vec2d(0, 0)) {
    for (Pair& pair : pairs_) {
        pair.step.resize(direction_.size());
        pair.change.resize(direction_.size());
    }
}

void FaceDescent::restart(const EnergyKind& kind) {
    kind_ = kind;
    known_ = 0;
    energy_ = energies_.evaluate(kind_, place_, slope_);
}

// The two loops of Nocedal 1980 around the Laplacian's inverse.
void FaceDescent::find_direction() {
    const std::vector<Id>& free = factor_.free();
    for (std::size_t i = 0; i < free.size(); ++i) direction_[i] = -slope_[free[i]];
    std::array<double, kPairs> share{};
    for (std::size_t n = 0; n < known_; ++n) {
        const std::size_t k = (newest_ + kPairs - n) % kPairs;
        share[k] = pairs_[k].inverse_product * product(pairs_[k].step, direction_);
        add(direction_, -share[k], pairs_[k].change);
    }
    factor_.solve(direction_);
    for (std::size_t n = known_; n-- > 0;) {
        const std::size_t k = (newest_ + kPairs - n) % kPairs;
        const double back = pairs_[k].inverse_product * product(pairs_[k].change, direction_);
        add(direction_, share[k] - back, pairs_[k].step);
    }
}

// Keeps the last step, `length` along the direction, if the energy is convex along it.
void FaceDescent::remember(double length) {
    const std::vector<Id>& free = factor_.free();
    const std::size_t next = known_ == 0 ? 0 : (newest_ + 1) % kPairs;
    Pair& pair = pairs_[next];
    for (std::size_t i = 0; i < free.size(); ++i) {
        pair.step[i] = length * direction_[i];
        pair.change[i] = new_slope_[free[i]] - slope_[free[i]];
    }
    const double across = product(pair.step, pair.change);
    if (!(across > 1e-10 * std::sqrt(product(pair.step, pair.step) * product(pair.change, pair.change))))
        return;
    pair.inverse_product = 1 / across;
    newest_ = next;
    known_ = std::min(known_ + 1, kPairs);
}

double FaceDescent::slope_along() const {
    const std::vector<Id>& free = factor_.free();
    double sum = 0;
    for (std::size_t i = 0; i < free.size(); ++i) sum += slope_[free[i]].dot(direction_[i]);
    return sum;
}

double FaceDescent::step() {
    find_direction();
    double slope = slope_along();
    if (!(slope < 0) && known_ > 0) {
        known_ = 0;
        find_direction();
        slope = slope_along();
    }
    return advance(slope);
}

double FaceDescent::step(HessianFactor& newton) {
    const std::vector<Id>& free = factor_.free();
    if (!newton.factorise(kind_, place_)) return 0;
    for (std::size_t i = 0; i < free.size(); ++i) direction_[i] = -slope_[free[i]];
    newton.solve(direction_);
    return advance(slope_along());
}

double FaceDescent::advance(double slope) {
    constexpr double kNearTurning = 0.8;  // of the way to where the first face would turn over
    constexpr double kEnough = 1e-4;      // of the decrease that the slope promises
    constexpr int kTries = 30;
    const std::vector<Id>& free = factor_.free();
    if (!(slope < 0)) return 0;
    double largest = 0;
    for (std::size_t i = 0; i < free.size(); ++i) {
        move_[free[i]] = direction_[i];
        largest = std::max(largest, direction_[i].lpNorm<Eigen::Infinity>());
    }
    double length = 1;
    if (kind_.form == EnergyKind::Form::kBarrier) {
        const double most = energies_.largest_step(place_, move_);
        if (most < 1) length = kNearTurning * most;
    }
    old_ = place_;
    for (int i = 0; i < kTries; ++i) {
        for (const Id v : free) place_[v] = old_[v] + length * move_[v];
        const double found = energies_.evaluate(kind_, place_, new_slope_);
        if (found <= energy_ + kEnough * length * slope) {
            remember(length);
            energy_ = found;
            slope_.swap(new_slope_);
            return length * largest;
        }
        // The lowest point of the parabola through the two energies and the slope.
        const double rise = found - energy_ - length * slope;
        const double best = std::isfinite(rise) ? -slope * length / (2 * rise) : 0;
        length *= std::clamp(best, 0.1, 0.5);
    }
    place_ = old_;
    return 0;
}

}  // namespace imgmesh
