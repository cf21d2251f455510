// The probability of a bit from several contexts: each context counts on its own, and a logistic mix weighs
// them (Mahoney 2005). All of it is integer arithmetic that stays within 32 bits, as decoders repeat it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace imgmesh::coding {

/// Log odds are in 1/256 of a natural unit, from -kMaxOdds to kMaxOdds.
inline constexpr int kMaxOdds = 2047;

extern const std::array<int, 2 * kMaxOdds + 1> kProbabilities;
extern const std::array<std::int16_t, 4096> kOdds;

/// Returns the probability of those log odds, in 1/2^16.
inline int probability_of(int odds) {
    return kProbabilities[static_cast<unsigned>(odds + kMaxOdds)];
}
/// Returns the log odds of a probability in 1/2^16.
inline int odds_of(int probability) {
    return kOdds[static_cast<unsigned>(probability >> 4)];
}

/// What a context knows: the probability of a 1, from few bits at first.
struct AdaptiveBit {
    std::uint16_t probability = 1u << 15;
    std::uint8_t seen = 0;

    void update(bool bit, int limit) {
        const int target = bit ? 65535 : 0;
        probability = static_cast<std::uint16_t>(probability + ((target - probability) * kRate[seen] >> 15));
        if (seen < limit) ++seen;
    }
    static const std::array<int, 256> kRate;  ///< 32768 / (seen + 2.5)
};

/// One kind of decision. Each of `Inputs` contexts has a table of its own.
template <std::size_t Inputs>
class BitModel {
  public:
    using Contexts = std::array<std::uint32_t, Inputs>;

    /// sizes  number of contexts of each input; weight_sets: how many sets of weights the decision chooses
    /// from
    explicit BitModel(const Contexts& sizes, std::size_t weight_sets = 1) : weights_(weight_sets) {
        for (std::size_t i = 0; i < Inputs; ++i) tables_[i].resize(sizes[i]);
        for (Weights& weights : weights_) {
            weights.of.fill(kFirstWeight);
            weights.of[Inputs] = kOne;
        }
    }

    /// Codes a bit. `prior` is what is expected before anything was seen, in log odds.
    template <class Coder>
    bool code(Coder& coder, bool bit, const Contexts& contexts, int prior = 0, std::size_t set = 0) {
        Weights& weights = weights_[set];
        const std::array<int, Inputs + 1> odds = odds_from(contexts, prior);
        const int mixed = probability_of(mix(weights, odds));
        bit = coder.code(bit, static_cast<std::uint32_t>(std::clamp(mixed >> 1, 16, 32768 - 16)));
        const int error = (bit ? 65535 : 0) - mixed;
        const int shift = weights.seen < kSettled ? 16 : 17;
        for (std::size_t i = 0; i <= Inputs; ++i)
            weights.of[i] = std::clamp(weights.of[i] + ((odds[i] * error + (1 << (shift - 1))) >> shift),
                                       -kMaxWeight, kMaxWeight);
        weights.seen += weights.seen < kSettled;
        for (std::size_t i = 0; i < Inputs; ++i) tables_[i][contexts[i]].update(bit, kLimit);
        return bit;
    }

    /// Returns the log odds of a 1.
    int odds(const Contexts& contexts, int prior = 0, std::size_t set = 0) const {
        return mix(weights_[set], odds_from(contexts, prior));
    }

  private:
    static constexpr int kWeightBits = 14, kOne = 1 << kWeightBits, kMaxWeight = 4 * kOne;
    static constexpr int kFirstWeight = static_cast<int>(kOne * 6 / 10 / Inputs);
    static constexpr int kLimit = 250, kSettled = 500;

    struct Weights {
        std::array<int, Inputs + 1> of;
        int seen = 0;
    };
    std::array<int, Inputs + 1> odds_from(const Contexts& contexts, int prior) const {
        std::array<int, Inputs + 1> out;
        for (std::size_t i = 0; i < Inputs; ++i) out[i] = odds_of(tables_[i][contexts[i]].probability);
        out[Inputs] = prior;
        return out;
    }
    static int mix(const Weights& weights, const std::array<int, Inputs + 1>& odds) {
        int sum = 0;
        for (std::size_t i = 0; i <= Inputs; ++i) sum += weights.of[i] * odds[i];
        return std::clamp(sum >> kWeightBits, -kMaxOdds, kMaxOdds);
    }

    std::array<std::vector<AdaptiveBit>, Inputs> tables_;
    std::vector<Weights> weights_;
};

}  // namespace imgmesh::coding
