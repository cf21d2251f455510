#include "libcore/tiles/line_segments.h"

#include <algorithm>
#include <numeric>
#include <queue>

#include "libcore/base/index.h"

namespace imgmesh {
namespace {

// A chain of vertices from which the cheapest go one by one.
class Chain {
  public:
    explicit Chain(int count) : before_(as_index(count)), after_(as_index(count)), version_(as_index(count)) {
        for (int v = 0; v < count; ++v) {
            before_[as_index(v)] = v - 1;
            after_[as_index(v)] = v + 1;
        }
    }

    // Removes inner vertices while `may_go(number left, cost)` allows it. cost(a, v, b) is that of removing v
    // from between a and b. In a tie the first one goes.
    template <class Cost, class MayGo>
    std::vector<int> reduce(const Cost& cost, const MayGo& may_go) {
        const int count = as_int(after_.size());
        const auto push = [&](int v) {
            if (v <= 0 || v + 1 >= count) return;
            queue_.push({cost(before_[as_index(v)], v, after_[as_index(v)]), v, version_[as_index(v)]});
        };
        for (int v = 1; v + 1 < count; ++v) push(v);
        int left = count;
        while (!queue_.empty()) {
            const Removal cheapest = queue_.top();
            queue_.pop();
            if (cheapest.version != version_[as_index(cheapest.vertex)]) continue;
            if (!may_go(left, cheapest.cost)) break;
            const int a = before_[as_index(cheapest.vertex)], b = after_[as_index(cheapest.vertex)];
            after_[as_index(a)] = b;
            before_[as_index(b)] = a;
            version_[as_index(cheapest.vertex)] = kGone;
            --left;
            for (const int v : {a, b}) {
                ++version_[as_index(v)];
                push(v);
            }
        }
        std::vector<int> kept;
        for (int v = 0; v < count; v = after_[as_index(v)]) kept.push_back(v);
        return kept;
    }

  private:
    static constexpr int kGone = -1;
    struct Removal {
        double cost;
        int vertex, version;
        // The queue's top is its largest.
        bool operator<(const Removal& other) const {
            return cost != other.cost ? cost > other.cost : vertex > other.vertex;
        }
    };

    std::vector<int> before_, after_, version_;
    std::priority_queue<Removal> queue_;
};

// Squared error of the best straight line over any run of pixels, from running sums.
class LineErrors {
  public:
    LineErrors(std::span<const float> line, int channels)
        : channels_(as_index(channels)), sums_((line.size() / channels_ + 1) * channels_) {
        const std::size_t count = line.size() / channels_;
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t c = 0; c < channels_; ++c) {
                const double f = line[i * channels_ + c];
                const Sums& s = sums_[i * channels_ + c];
                sums_[(i + 1) * channels_ + c] = {s.f + f, s.xf + static_cast<double>(i) * f, s.ff + f * f};
            }
    }

    // Of the pixels first to last, both included.
    double of(int first, int last) const {
        const double n = last - first + 1;
        if (n <= 2) return 0;
        const double middle = 0.5 * (first + last), spread = n * (n * n - 1) / 12;
        double error = 0;
        for (std::size_t c = 0; c < channels_; ++c) {
            const Sums& from = sums_[as_index(first) * channels_ + c];
            const Sums& to = sums_[as_index(last + 1) * channels_ + c];
            const double f = to.f - from.f, slope = to.xf - from.xf - middle * f;
            error += std::max(0.0, to.ff - from.ff - f * f / n - slope * slope / spread);
        }
        return error;
    }

  private:
    struct Sums {
        double f = 0, xf = 0, ff = 0;
    };
    std::size_t channels_;
    std::vector<Sums> sums_;
};

// A mesh around a line gives way to it, but a line cannot give way to the mesh: it counts more. So
// pixels at most two from a side have no larger error than others, at 1 to 4 % of the pixels
// (docs/decisions/0051-tile-sets.md).
constexpr double kWeightOfLines = 32;

// What the removal of v from between a and b adds.
double removal_cost(const LineErrors& errors, int a, int v, int b) {
    return kWeightOfLines * (errors.of(a, b) - errors.of(a, v) - errors.of(v, b)) * 0.5 * (b - a);
}

}  // namespace

std::vector<int> line_vertices(std::span<const float> line, int channels, double threshold) {
    const LineErrors errors(line, channels);
    return Chain(as_int(line.size()) / channels)
        .reduce([&](int a, int v, int b) { return removal_cost(errors, a, v, b); },
                [&](int, double added) { return added <= threshold; });
}

std::vector<int> line_vertex_counts(std::span<const float> line, int channels,
                                    std::span<const double> thresholds) {
    const int count = as_int(line.size()) / channels;
    const LineErrors errors(line, channels);
    std::vector<int> counts;
    // A threshold ends where the first removal costs more.
    Chain(count).reduce([&](int a, int v, int b) { return removal_cost(errors, a, v, b); },
                        [&](int left, double added) {
                            while (counts.size() < thresholds.size() && thresholds[counts.size()] < added)
                                counts.push_back(left);
                            return true;
                        });
    counts.resize(thresholds.size(), std::min(count, 2));
    return counts;
}

std::vector<int> half_of_vertices(std::span<const int> places, std::span<const float> features,
                                  int channels) {
    const int count = as_int(places.size()), wanted = count / 2 + 1;
    const auto cost = [&](int a, int v, int b) {
        const double length = places[as_index(b)] - places[as_index(a)];
        const double t = (places[as_index(v)] - places[as_index(a)]) / length;
        double squares = 0;
        for (int c = 0; c < channels; ++c) {
            const auto at = [&](int i) { return double{features[as_index(i * channels + c)]}; };
            const double d = at(v) - ((1 - t) * at(a) + t * at(b));
            squares += d * d;
        }
        return squares * length * length;
    };
    return Chain(count).reduce(cost, [&](int left, double) { return left > wanted; });
}

}  // namespace imgmesh
