// What is expected of the next colour of a mesh from those that are known.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "libcore/coding/color_mixture.h"
#include "libcore/coding/color_plan.h"

namespace imgmesh::coding {

/// What is known of one channel of one vertex before its level is. Lengths are in colour units.
struct ColorGuess {
    std::size_t channel = 0;
    std::int32_t step = 1, value = 0;  ///< the colour is value + step * level
    ColorMixture mixture;              ///< where the colour may lie
    std::int32_t less = 0, more = 0;   ///< the mixture's weight of levels below 0, and above
    int spread = 0, surprise = 0;      ///< of the neighbours: 16 log2 of their share of a step
    std::int32_t nearest = 0;          ///< colour of the neighbour that counts most, less `value`
    std::size_t neighbors = 0;         ///< how many are known
    std::array<int, 2> before{};       ///< levels of the vertex's first two channels, if known

    /// Returns the mixture's weight of what lies farther from 0 than that level does.
    std::int32_t beyond(int level) const {
        const std::int32_t half = (step + 1) / 2, at = value + level * step;
        return level < 0 ? mixture.below(at - half) : mixture.all() - mixture.below(at + half);
    }
};

class ColorGuesser {
  public:
    static constexpr std::int32_t kMaxStep = 1 << 14;

    /// steps  of each coded channel, 1 to kMaxStep colour units
    ColorGuesser(const ColorPlan& plan, int channels, const std::array<std::int32_t, 4>& steps);

    /// Vertices go in order, and their channels too: a guess is followed by its level.
    ColorGuess guess(std::size_t vertex, std::size_t channel);
    void set_level(std::size_t vertex, const ColorGuess& guess, int level);

    /// Size V * channels, interleaved, in coded channels (color_transform.h).
    std::span<const std::int32_t> values() const { return color_; }

  private:
    std::int32_t mean(std::size_t vertex, std::size_t channel, const std::vector<std::int32_t>& of) const;
    std::int32_t spread(std::size_t vertex, std::size_t channel, std::int32_t around) const;
    std::int32_t first_color(std::size_t vertex, std::size_t channel) const;
    std::int32_t gain_with_light(std::size_t vertex, const ColorGuess& guess) const;
    void set_mixture(std::size_t vertex, ColorGuess& guess) const;
    std::int32_t step_of(std::size_t vertex, std::size_t channel) const;

    const ColorPlan& plan_;
    std::size_t channels_;
    std::array<std::int32_t, 4> steps_;
    std::array<std::int32_t, 4> guessed_{};  // of the vertex's channels so far
    std::vector<std::int32_t> color_;
    std::vector<std::int32_t> calm_;      // colours drawn towards what had been expected of them
    std::vector<std::int32_t> surprise_;  // how far they were from that
    std::array<int, 2> before_{};
    std::array<std::int32_t, 4> recent_{};  // mean size of levels of late, by channel
    std::vector<int> log_fineness_;
};

}  // namespace imgmesh::coding
