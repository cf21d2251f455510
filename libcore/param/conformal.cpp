#include "libcore/param/conformal.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "libcore/base/index.h"

namespace imgmesh {

bool flatten_ring(const float* pivot, std::span<const float* const> ring, int dimensions, bool open,
                  FlatRing& flat) {
    const std::size_t n = ring.size();
    assert(n >= 2 && n <= kMaxFlatRing);
    // |r_k - pivot|^2, and the inner products of neighbours.
    std::array<double, kMaxFlatRing> square{}, product{}, angle{};
    for (std::size_t k = 0; k < n; ++k) {
        const float *here = ring[k], *next = ring[k + 1 < n ? k + 1 : 0];
        for (int c = 0; c < dimensions; ++c) {
            const double d = double(here[c]) - double(pivot[c]), e = double(next[c]) - double(pivot[c]);
            square[k] += d * d;
            product[k] += d * e;
        }
    }
    double total = 0, mean = 0;
    for (std::size_t k = 0; k < n; ++k) {
        if (!(square[k] > 0)) return false;
        mean += std::sqrt(square[k]) / double(n);
        if (open && k + 1 == n) break;
        const double cosine = product[k] / std::sqrt(square[k] * square[k + 1 < n ? k + 1 : 0]);
        angle[k] = std::acos(std::clamp(cosine, -1.0, 1.0));
        total += angle[k];
    }
    if (!(total > 0)) return false;
    const double full = open ? std::numbers::pi : 2 * std::numbers::pi;
    flat.exponent = full / total;
    flat.mean = mean;
    double at = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const double radius = std::pow(std::sqrt(square[k]) / mean, flat.exponent);
        flat.at[k] = open && k + 1 == n ? Vec2d(-radius, 0)
                                        : Vec2d(radius * std::cos(flat.exponent * at),
                                                radius * std::sin(flat.exponent * at));
        at += angle[k];
    }
    return true;
}

bool FlatFan::set(const Vec2d& center, std::span<const Vec2d> ring, bool closed) {
    assert(ring.size() >= 2 && ring.size() <= kMaxFlatRing);
    center_ = center;
    const std::size_t n = ring.size();
    size_ = as_int(closed ? n : n - 1);
    for (std::size_t k = 0; k < as_index(size_); ++k) {
        const Vec2d r = ring[k] - center, s = ring[k + 1 < n ? k + 1 : 0] - center;
        const double area2 = r.x() * s.y() - r.y() * s.x();
        const double longest = std::max({r.squaredNorm(), s.squaredNorm(), (r - s).squaredNorm()});
        if (!(area2 > kLeastFlatness * longest)) return false;
        triangles_[k] = {r.x(), r.y(), s.x(), s.y(), 1 / area2};
    }
    return true;
}

FanPoint FlatFan::locate(const Vec2d& p) const {
    const double x = p.x() - center_.x(), y = p.y() - center_.y();
    FanPoint best;
    double best_least = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < size_; ++k) {
        const Triangle& t = triangles_[as_index(k)];
        // Written so that a point on a border (y = 0, as the triangle's own) keeps an exact 0.
        const double u = (x * t.sy - y * t.sx) * t.inverse, v = (t.rx * y - t.ry * x) * t.inverse;
        const double least = std::min({u, v, 1 - u - v});
        if (least > best_least) {
            best_least = least;
            best = {k, {1 - u - v, u, v}};
            if (least >= 0) return best;
        }
    }
    double sum = 0;
    for (double& w : best.weight) sum += w = std::max(0.0, w);
    for (double& w : best.weight) w /= sum;
    return best;
}

}  // namespace imgmesh
