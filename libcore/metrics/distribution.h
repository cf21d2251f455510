// Summarises many numbers: mean, deviation, percentiles, and a histogram over fixed bins.
#pragma once

#include <cstdint>
#include <vector>

namespace imgmesh {

/// `count` bins of equal width over [low, high]. A value on an edge between two bins belongs to the upper
/// one; `high` itself belongs to the last bin.
struct Bins {
    double low = 0;
    double high = 1;
    int count = 1;
};

/// A summary of many numbers.
struct Distribution {
    std::int64_t count = 0;  ///< number of values; if it is 0, all figures except the histogram are NaN
    double mean = 0;
    double deviation = 0;  ///< standard deviation of the values themselves (divided by count)
    double min = 0;
    /// Percentiles are linear between the sorted values: the least is the 0th, the greatest the 100th.
    double p5 = 0, p25 = 0, median = 0, p75 = 0, p95 = 0;
    double max = 0;

    Bins bins;
    std::vector<std::int64_t> histogram;  ///< size bins.count
    std::int64_t below = 0;               ///< values below bins.low
    std::int64_t above = 0;               ///< values above bins.high
};

/// Summarises `values`. Leaves out NaNs; other values must be finite. bins.low < bins.high, bins.count >= 1.
/// Takes O(n) time.
Distribution distribution(std::vector<float> values, const Bins& bins);

}  // namespace imgmesh
