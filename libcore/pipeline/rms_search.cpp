#include "libcore/pipeline/rms_search.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace imgmesh {
namespace {

using Probe = MeasuredMeshes::Probe;

// RMS ~ vertices^-slope: 0.3 on photographs with few vertices to 0.7 with many.
constexpr double kUsualSlope = 0.45, kLeastSlope = 0.2, kMostSlope = 1.2;
// The share of the wanted error to aim for, and the share that is close enough: 1.5 % of the error are 4 % of
// the vertices.
constexpr double kAim = 0.9925, kReached = 0.985;
// With few vertices errors jump by a percent between meshes, so precision is relaxed after two meshes.
constexpr double kYield = 0.01;
constexpr std::int64_t kLeast = 4;

// Returns how many vertices have the error `aim`, if `probe` is on the power law.
double predicted(const Probe& probe, double aim, double slope) {
    if (probe.rms <= 0) return 0;
    return static_cast<double>(probe.vertices) * std::pow(probe.rms / std::max(aim, 1e-12), 1 / slope);
}

double slope_between(const Probe& a, const Probe& b) {
    const double steps = std::log(static_cast<double>(a.vertices) / static_cast<double>(b.vertices));
    // Values that are too close together, or not finite, give no slope.
    if (!(std::abs(steps) > 0.01) || !(a.rms > 0) || !(b.rms > 0)) return kUsualSlope;
    return std::clamp(std::log(b.rms / a.rms) / steps, kLeastSlope, kMostSlope);
}

}  // namespace

bool search_rms(std::int64_t vertices, std::int64_t guess, double rms, MeasuredMeshes& meshes) {
    const double aim = kAim * rms;
    const auto limited = [&](double n) {
        return static_cast<std::int64_t>(
            std::clamp(n, static_cast<double>(kLeast), static_cast<double>(vertices)));
    };
    // Start with estimates: one at the guess, one where the goal seems to be or, if that is above, a little
    // below the guess, because a collapse cannot go back. They also give the slope.
    double slope = kUsualSlope;
    const Probe first = meshes.estimated(std::clamp(guess, kLeast, vertices));
    const double there = predicted(first, aim, slope);
    std::int64_t next = limited(there);
    if (first.vertices > 2 * kLeast) {
        const Probe second =
            meshes.estimated(limited(std::min(1.7 * there, 0.7 * static_cast<double>(first.vertices))));
        slope = slope_between(first, second);
        next = limited(predicted(second, aim, slope));
    }
    std::optional<Probe> enough, too_few, last;
    // Predictions soon give way to bisection on a logarithmic scale, which always ends.
    constexpr int kPredictions = 6;
    for (int step = 0;; ++step) {
        const Probe probe = meshes.finished(next);
        const bool coarsest = probe.vertices > next;  // no mesh has fewer vertices
        if (probe.rms <= rms) {
            if (!enough || probe.vertices < enough->vertices) {
                enough = probe;
                meshes.keep();
            }
            if (coarsest || probe.vertices <= kLeast ||
                probe.rms >= (kReached - kYield * std::max(0, step - 1)) * rms)
                return true;
        } else {
            if (probe.vertices >= vertices || (coarsest && enough)) return enough.has_value();
            if (!too_few || probe.vertices > too_few->vertices) too_few = probe;
        }
        const double low = too_few ? static_cast<double>(too_few->vertices) + 1 : double(kLeast);
        const double high = enough ? static_cast<double>(enough->vertices) - 1 : double(vertices);
        if (low > high || (enough && too_few && high < 1.035 * low)) return enough.has_value();
        if (last) slope = slope_between(probe, *last);
        double wanted = predicted(probe, aim, slope);
        if (step >= kPredictions || !(wanted < 1e18))
            wanted = enough ? std::sqrt(low * high) : 8 * static_cast<double>(too_few->vertices);
        last = probe;
        next = limited(std::clamp(wanted, low, high));
    }
}

}  // namespace imgmesh
