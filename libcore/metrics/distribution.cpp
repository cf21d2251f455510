#include "libcore/metrics/distribution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "libcore/base/index.h"

namespace imgmesh {
namespace {

void count_bins(const std::vector<float>& values, Distribution& d) {
    const double width = (d.bins.high - d.bins.low) / d.bins.count;
    d.histogram.assign(as_index(d.bins.count), 0);
    for (const float value : values) {
        if (value < d.bins.low) {
            ++d.below;
        } else if (value > d.bins.high) {
            ++d.above;
        } else {
            const auto bin = static_cast<std::size_t>((value - d.bins.low) / width);
            ++d.histogram[std::min(bin, d.histogram.size() - 1)];
        }
    }
}

// Percentiles in rising order, so that each needs to look only at the values above the previous one.
void find_percentiles(std::vector<float>& values, Distribution& d) {
    auto sorted_to = values.begin();
    const auto last = double(values.size() - 1);
    for (const auto& [share, target] :
         {std::pair{0.05, &d.p5}, std::pair{0.25, &d.p25}, std::pair{0.5, &d.median}, std::pair{0.75, &d.p75},
          std::pair{0.95, &d.p95}}) {
        const double place = share * last;
        const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
        std::nth_element(sorted_to, at, values.end());
        const double next = at + 1 < values.end() ? *std::min_element(at + 1, values.end()) : *at;
        *target = *at + (place - std::floor(place)) * (next - *at);
        sorted_to = at;
    }
}

}  // namespace

Distribution distribution(std::vector<float> values, const Bins& bins) {
    std::erase_if(values, [](float value) { return std::isnan(value); });
    Distribution d;
    d.bins = bins;
    d.count = std::ssize(values);
    count_bins(values, d);
    if (values.empty()) {
        for (double* figure :
             {&d.mean, &d.deviation, &d.min, &d.p5, &d.p25, &d.median, &d.p75, &d.p95, &d.max})
            *figure = std::numeric_limits<double>::quiet_NaN();
        return d;
    }
    double sum = 0, squares = 0;
    for (const float value : values) sum += value;
    d.mean = sum / double(values.size());
    for (const float value : values) squares += (value - d.mean) * (value - d.mean);
    d.deviation = std::sqrt(squares / double(values.size()));
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    d.min = *least;
    d.max = *greatest;
    find_percentiles(values, d);
    return d;
}

}  // namespace imgmesh
