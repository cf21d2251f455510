// Random numbers that are the same everywhere.
#pragma once

#include <cmath>
#include <cstdint>

namespace imgmesh {

/// Source: Steele, Lea and Flood, Fast splittable pseudorandom number generators, OOPSLA 2014 (SplitMix64).
class GridRandom {
  public:
    explicit GridRandom(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }
    /// Returns about a Gaussian number of variance 1: the sum of four of 16 bits.
    double gaussian() {
        const std::uint64_t bits = next();
        const std::uint64_t sum =
            (bits & 0xFFFF) + (bits >> 16 & 0xFFFF) + (bits >> 32 & 0xFFFF) + (bits >> 48);
        constexpr double kMean = 2 * 65535.0, kDeviation = 37837.0;
        return (static_cast<double>(sum) - kMean) / kDeviation;
    }
    /// Returns about -ln(u) of a uniform u: its highest set bit, and a parabola between powers of two. The
    /// error is below 0.01. No library function, as their last bits differ.
    double exponential() {
        std::uint64_t bits = next() | 1;
        double halvings = 1;
        while (!(bits >> 63)) {
            bits <<= 1;
            halvings += 1;
        }
        // u = mantissa / 2 * 2^(1 - halvings) with the mantissa in [1, 2).
        const double m = static_cast<double>(bits >> 11) * 0x1p-52 - 1;
        const double log2 = m * (1.3442 - 0.3442 * m);
        return 0.6931471805599453 * (halvings - log2);
    }

  private:
    std::uint64_t state_;
};

}  // namespace imgmesh
