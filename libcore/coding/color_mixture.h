// Where a colour is expected: around its prediction, and around the colour of each neighbour, exponentially
// less the farther away. It gives the first guess of each bit of a level.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace imgmesh::coding {

class ColorMixture {
  public:
    static constexpr std::size_t kMost = 13;

    /// Adds a place, in colour units. half: the distance over which it halves, >= 1; weights sum up to less
    /// than 2^17.
    void add(std::int32_t place, std::int32_t half, std::int32_t weight) {
        parts_[count_++] = {place, (1 << 24) / half, weight};
        all_ += weight << 14;
    }
    /// Returns 2^14 times the weight below that value, which is less than 2^20 away.
    std::int32_t below(std::int32_t value) const;
    /// Returns 2^14 times all weights.
    std::int32_t all() const { return all_; }

  private:
    struct Part {
        std::int32_t place, rate, weight;
    };
    std::array<Part, kMost> parts_{};
    std::size_t count_ = 0;
    std::int32_t all_ = 0;
};

}  // namespace imgmesh::coding
